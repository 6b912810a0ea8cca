"""The order in h of ΔJ for one Hamiltonian, and the order of the map itself.

A map that does nothing preserves area, so area alone proves no scheme: the Taylor coefficients of
p' and q' in h are held against those of the exact flow, Xⁿp/n! and Xⁿq/n!.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache, partial

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.embedding import embed
from verify.algebra.ring import Decision, Poly, Ring
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.plane_flow import PlaneFlow
from verify.hamiltonians.vector_field import VectorField
from verify.late import sympy
from verify.proof.by_conditions import nearby_order, told_nearby
from verify.proof.claimed import IN_PLANE, Claimed, Convergence, held_to
from verify.proof.expansion import MOST_ORDERS, VANISHES, Expansion, Leading, first_nonzero
from verify.proof.order_proof import Proof
from verify.proof.parameters import almost_all, not_zero_for
from verify.proof.printed_formulas import nearby_defect, nearby_of_formulas, told_defect
from verify.prose import Formula, Prose, prose
from verify.schemes.conditions import Condition, NearbyOrder
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting
from verify.schemes.splitting_conditions import Splitting
from verify.schemes.step_algebra import State
from verify.schemes.step_map import StepMap
from verify.schemes.timed.for_scheme import conditions_for
from verify.verdict import Verdict

RESIDUE = Fraction(1, 2**100)  # and above it what the coefficients of the nearest leave
_FIRST_ORDERS = 6  # of them, those that are made at once where no order is claimed


def prove(step_map: StepMap, scheme: Scheme | None = None) -> Proof:
    """The order of ΔJ and of the map by exact algebra, and whether `scheme`'s claims hold."""
    first = scheme.order + 1 if scheme else _FIRST_ORDERS
    convergence, near = convergence_of_scheme(step_map, scheme, first)
    leading, domain = leading_of(step_map, first), step_map.domain
    inside = leading.within(domain)
    claimed = Claimed.of(scheme) if scheme else Claimed()
    defect = inside.power, inside.decision.zero
    verdict, reason = held_to(claimed, convergence, defect, MOST_ORDERS, IN_PLANE)
    if inside.decision.zero is None and leading.decision.zero is not None:
        reason = prose("no point is found where all is defined: ", domain.prose)
    leading = inside
    if leading.decision.zero is True and step_map.conditions:
        reason = prose(reason, ", ", _by_conditions(step_map.conditions))
    if verdict is Verdict.PROVED and leading.domain:
        reason = prose(reason, ", where ", leading.domain.prose)
    without = nearby_defect_of(scheme, step_map.hamiltonian, leading.power)
    verdict, reason = with_nearby((verdict, reason), near, without, "ΔJ")
    return Proof(
        verdict=verdict,
        reason=reason,
        order=leading.power if leading.decision.zero is False else None,
        first=leading,
        area_preserving=leading.decision.zero,
        convergence_order=convergence.order,
        step_map=step_map,
        witness=leading.decision.witness,
        enclosure=leading.decision.enclosure,
        convergence_decided=convergence.decided,
    )


def _by_conditions(conditions: Sequence[Condition]) -> Prose:
    first = Formula(conditions[0].name)
    if len(conditions) == 1:
        return prose("as ", first, " holds exactly, for every H")
    return prose(
        f"as {len(conditions)} conditions on its coefficients hold exactly (", first, ", …)"
    )


@lru_cache(maxsize=4)
def _series_of(step_map: StepMap, first: int) -> DefectSeries[PlaneFlow] | None:
    """The coefficients of a map of several parts, without its closed form; None where it has none.

    They are made as far as they are looked at; `first`: those of them that are made at once.
    """
    start = step_map.taylor(first) if step_map.of_parts else None
    if start is None:
        return None

    def made(most: int) -> tuple[PlaneFlow, State]:
        more = min(most, MOST_ORDERS)  # terms multiply with every order
        expanded = start if most == first else step_map.taylor(more)
        assert expanded is not None  # noqa: S101 - it has had fewer terms
        field, p, q = expanded
        return PlaneFlow(field), (p, q)

    return DefectSeries(made, first)


def leading_of(step_map: StepMap, first: int = _FIRST_ORDERS) -> Leading:
    """The first coefficient in h of ΔJ that is not shown to vanish; `first`: so many are made at
    once."""
    if step_map.preserves_area:
        return VANISHES
    series = _series_of(step_map, first)
    if series is not None:
        return _leading_by(series, step_map)
    step = step_map.flat
    if step.preserves_area:
        return VANISHES
    if step.degree is None:
        leading = Expansion(step.ring, step.delta_j).leading()
        if leading.decision.zero is None and leading.power == MOST_ORDERS + 1:
            return _beyond(step.ring, step.delta_j)
        return leading
    found = first_nonzero(lambda n: (step.ring, step.coefficient(n)), step.degree + 1)
    return found or VANISHES


def _leading_by(series: DefectSeries[PlaneFlow], step_map: StepMap) -> Leading:
    def coefficient(n: int) -> tuple[Ring, Poly]:
        x = series.form(n).divergence
        return series.flow.ring, x

    found = first_nonzero(coefficient, MOST_ORDERS + 1)
    if found is not None:
        return found
    whole = step_map.whole
    if whole.preserves_area:
        return VANISHES
    if step_map.implicit:
        return Leading(MOST_ORDERS + 1, Decision(None))
    return _beyond(whole.ring, whole.delta_j)


def _beyond(ring: Ring, delta_j: Poly) -> Leading:
    """Where all coefficients that are looked at vanish; ΔJ itself may still be shown not to."""
    decision = ring.decide(delta_j)
    if decision.zero is None:
        return Leading(MOST_ORDERS + 1, decision)
    return Leading(None, decision, None if decision.zero else (ring, delta_j))


def convergence_of(
    step_map: StepMap, first: int = _FIRST_ORDERS, residues: bool = False
) -> Convergence:
    """The order to which the map agrees with the exact flow; with `residues`, up to such."""
    known = step_map.known_order()
    if known is not None:
        # Shown at a point, without its coefficient.
        exact, what = step_map.hamiltonian, f"the difference at h^{known + 1}"
        almost = almost_all(exact.symbols, what, exact.time_dependent) if exact.symbols else ""
        return Convergence(known, True, lambda: Domain.of((), almost) if almost else EVERYWHERE)
    begin, series = _first_to_look_at(step_map), _series_of(step_map, first)
    if series is not None:
        return convergence_by(series, begin, MOST_ORDERS, residues)
    step = step_map.flat
    pairs = zip((step.p_next, step.q_next), step.terms or (None, None), strict=True)
    expansions = [Expansion(step.ring, x, terms) for x, terms in pairs]
    for n in range(begin, max(MOST_ORDERS, *(x.length for x in expansions)) + 1):
        for name, expansion in zip(("p", "q"), expansions, strict=True):
            own, x = expansion.coefficient(n)
            ring, gap = _gap(step.field, own, x, name, n)
            if residues and own is ring and is_residue(ring.reduce(gap), x):
                continue
            agrees = ring.vanishes(gap)
            if agrees is not True:
                what = f"the difference at h^{n}"
                return Convergence(n - 1, agrees is False, partial(not_zero_for, ring, gap, what))
    return Convergence(None, True)


def convergence_by(
    series: "DefectSeries[PlaneFlow] | DefectSeries[CanonicalField]",
    begin: int,
    most: int,
    residues: bool = False,
) -> Convergence:
    """By the coefficients of h^begin … h^most of a map, in any number of degrees of freedom."""
    for n in range(begin, most + 1):
        agrees, gap = series.agrees(n, is_residue if residues else None)
        if agrees is not True:
            exact_for = partial(not_zero_for, series.flow.ring, gap, f"the difference at h^{n}")
            return Convergence(n - 1, agrees is False, exact_for)
    return Convergence(None, True)


def convergence_of_scheme(
    step_map: StepMap, scheme: Scheme | None, first: int = _FIRST_ORDERS
) -> tuple[Convergence, NearbyOrder | None]:
    """As `convergence_of`, of exact coefficients where those of the scheme are printed."""
    printed = convergence_of(step_map, first)
    exact = step_map.hamiltonian
    return nearby_convergence(scheme, printed, exact, partial(_of_scheme, exact))


def nearby_convergence(
    scheme: Scheme | None,
    printed: Convergence,
    hamiltonian: Hamiltonian,
    of: Callable[[Scheme], Convergence],
) -> tuple[Convergence, NearbyOrder | None]:
    """The order of exact coefficients near those that a scheme prints, where it is higher than that
    of these; `of` finds that of a scheme whose coefficients are right to `RESIDUE` and better."""
    near = nearby_of_scheme(scheme, hamiltonian) if scheme else None
    if scheme is None or near is None or printed.order is None or near.order <= printed.order:
        return printed, None
    # What none near the printed ones satisfy is of this H where the scheme is known for one alone.
    found = Convergence(near.order, scheme.every_h is None and near.wrong is not None)
    if near.parts:
        nearest = splitting(
            scheme.name,
            near.parts,
            order=near.order,
            symmetric=False,
            source=scheme.source,
            times=tuple(None if x is None else sympy.sympify(x) for x in near.times),
        )
        exact = of(nearest)
        found = exact if exact.order is None or exact.order >= near.order else found
    return found, near


def nearby_of_scheme(scheme: Scheme, hamiltonian: Hamiltonian) -> NearbyOrder | None:
    """The order of exact coefficients near those that the scheme prints; None where it prints none,
    or none near them make a scheme."""
    if scheme.formulas:
        return nearby_of_formulas(tuple(scheme.formulas.items()), hamiltonian)
    every_h = scheme.every_h
    timed = hamiltonian.time_dependent and isinstance(every_h, Splitting)
    return nearby_order(conditions_for(every_h) if timed else every_h, scheme.order)


def nearby_defect_of(
    scheme: Scheme | None, hamiltonian: Hamiltonian, power: int | None
) -> NearbyOrder | None:
    """Where the term of h^power in ΔJ, or S, is what the digits of a user's formulas leave: up to
    which power there is none with exact coefficients near them."""
    if scheme is None or not scheme.formulas or power is None:
        return None
    near = nearby_defect(tuple(scheme.formulas.items()), hamiltonian)
    return near if near is not None and near.order >= power else None


def _of_scheme(hamiltonian: Hamiltonian, scheme: Scheme) -> Convergence:
    return convergence_of(scheme.step_map(hamiltonian), residues=True)


def with_nearby(
    judged: tuple[Verdict, Prose], near: NearbyOrder | None, without: NearbyOrder | None, form: str
) -> tuple[Verdict, Prose]:
    """With what exact coefficients near printed ones have: a higher order, or no such term."""
    verdict, reason = judged
    if near is not None and verdict is Verdict.PROVED:
        verdict, reason = near.verdict, prose(reason, "; ", told_nearby(near))
    return verdict, reason if without is None else prose(reason, "; ", told_defect(without, form))


def is_residue(gap: Poly, term: Poly) -> bool:
    """Whether a difference from a term is of coefficients that are right to some 90 digits."""
    return size_of(gap) < RESIDUE * max(size_of(term), size_of(term - gap))


def size_of(x: Poly) -> Fraction:
    """The largest coefficient."""
    return max((abs(Fraction(int(c.p), int(c.q))) for c in x.coeffs()), default=Fraction(0))


def _first_to_look_at(step_map: StepMap) -> int:
    """η + 1 of the map that was made as the flow's terms up to η: these need no comparison."""
    first, *more = step_map.substeps
    eta = None if more else first.field.truncated_at(first.p_next, first.q_next)
    return 0 if eta is None else eta + 1


def _gap(field: VectorField, own: Ring, x: Poly, name: str, n: int) -> tuple[Ring, Poly]:
    """x less the coefficient of hⁿ in the exact flow, with the ring that it is an element of."""
    ring, flow = field.ring, field.power(name, n)
    if own is ring:
        return ring, x - flow / math.factorial(n)
    gap = own.expression(x) - ring.expression(flow) / math.factorial(n)
    common, (difference,) = embed([gap], ring.variables)
    return common, difference
