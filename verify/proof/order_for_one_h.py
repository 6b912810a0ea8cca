"""The order in h of S = JᵀΩJ − Ω for one Hamiltonian, and the order of the map itself.

In the plane S is ΔJ dp∧dq. In more degrees of freedom det J ≡ 1 is weaker than S ≡ 0, and both are
examined. A map that does nothing is symplectic, so that the order of the map is proved too: the
Taylor coefficients of z' in h are compared with those of the exact flow, Xⁿz/n!.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.ring import Decision, Poly
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.expansion import MOST_ORDERS, VANISHES, AnySeries, Leading, series_of
from verify.proof.order_conditions import describe_nearby, nearby_order
from verify.proof.parameters import almost_all, not_zero_for
from verify.proof.printed_formulas import describe_nearby_defect, nearby_defect, nearby_of_formulas
from verify.proof.proof_for_one_h import Convergence, Proof, SchemeClaims, judge_claims
from verify.proof.telescoping import telescopes_of_lie
from verify.prose import Formula, Prose, prose
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

RESIDUAL = Fraction(1, 2**100)  # a smaller relative residual is that of 90-digit coefficients
FIRST_ORDERS = 6  # the power of h up to which a map is expanded at once, if no order is claimed
_MOST_IN_DEGREES = 8  # the power of h examined in n degrees, if the claimed order is below


def prove(step_map: StepMap, scheme: Scheme | None = None) -> Proof:
    """Prove the orders of S and of the map by exact algebra, and judge what `scheme` claims."""
    claimed = SchemeClaims.from_scheme(scheme) if scheme else SchemeClaims()
    first = scheme.order + 1 if scheme else FIRST_ORDERS
    planar = step_map.hamiltonian.planar
    most = MOST_ORDERS if planar else max(_MOST_IN_DEGREES, claimed.order + 1)
    convergence, near = convergence_of_scheme(step_map, scheme, first, most)
    leading, domain = leading_of(step_map, first, most), step_map.domain
    leading_inside = leading.restrict_to(domain)
    defect = leading_inside.power, leading_inside.decision.zero
    verdict, reason = judge_claims(claimed, convergence, defect, most, step_map.structure)
    if leading_inside.decision.zero is None and leading.decision.zero is not None:
        reason = prose("no point is found where all is defined: ", domain.prose)
    if planar:
        reason = _with_conditions(reason, verdict, leading_inside, step_map)
    without = nearby_defect_of(scheme, step_map.hamiltonian, leading_inside.power)
    verdict, reason = with_nearby((verdict, reason), near, without, step_map.structure.symbol)
    telescopes, potential = telescoping_of(step_map, first, leading_inside)
    return Proof(
        verdict=verdict,
        reason=reason,
        step_map=step_map,
        first=leading_inside,
        volume=leading_inside if planar else _volume(step_map, first, leading_inside, most),
        convergence_order=convergence.order,
        convergence_decided=convergence.decided,
        telescopes=telescopes,
        potential=potential,
        nearby=near,
    )


def _with_conditions(reason: Prose, verdict: Verdict, leading: Leading, step_map: StepMap) -> Prose:
    """Add to the reason the conditions by which ΔJ ≡ 0, or the parameters for which ΔJ ≢ 0."""
    if leading.decision.zero is True and step_map.implicit and step_map.conditions:
        reason = prose(reason, ", ", _by_conditions(step_map.conditions))
    if verdict is Verdict.PROVED and leading.domain:
        reason = prose(reason, ", where ", leading.domain.prose)
    return reason


def _by_conditions(conditions: Sequence[Condition]) -> Prose:
    first = Formula(conditions[0].name)
    if len(conditions) == 1:
        return prose("as ", first, " holds exactly, for every H")
    return prose(
        f"as {len(conditions)} conditions on its coefficients hold exactly (", first, ", …)"
    )


# -- S, det J and telescoping ---------------------------------------------------------------------


def leading_of(step_map: StepMap, first: int = FIRST_ORDERS, most: int = MOST_ORDERS) -> Leading:
    """Return the leading coefficient of S: the first in h that is not shown to vanish.

    `first`: the power of h up to which the map is expanded at once. `most`: the last power examined
    if S is no polynomial in h.
    """
    if step_map.preserves_area:
        return VANISHES
    series = series_of(step_map, first)
    closed = step_map.closed if step_map.formulas is not None else None
    polynomial = closed is not None and closed.degree is not None and step_map.expand is None
    highest = 2 * (closed.degree or 0) if polynomial and closed else most
    for m in range(step_map.flow_up_to + 1, highest + 1):
        form = series.form(m)
        leading = Leading.of_form(m, form, form.ring)
        if leading.decision.zero is not True:
            return leading
    # S is quadratic in z', so its degree in h is at most twice that of the map.
    if polynomial:  # S is a polynomial in h, all of whose coefficients vanish
        return VANISHES
    power_beyond = {AREA: most + 1, SYMPLECTIC: None}[step_map.structure]
    if step_map.closed is None:
        return Leading(power_beyond, Decision(None))
    defect = step_map.closed.defect
    leading = Leading.of_form(None, defect, step_map.closed.ring)
    undecided = leading.decision.zero is None and power_beyond is not None
    return Leading(power_beyond, leading.decision) if undecided else leading


def _volume(step_map: StepMap, first: int, defect: Leading, most: int) -> Leading:
    """Return the leading coefficient of det J − 1, undecided if an earlier one is undecided."""
    # det J − 1 has no terms below the order of S.
    if defect.decision.zero is not False:
        return Leading(None, defect.decision)
    series = series_of(step_map, first)
    for n in range(defect.power or 0, most + 1):
        ring, x = series.volume(n)
        zero = ring.vanishes(x)
        if zero is False:
            return Leading(n, Decision(False), (ring, x))
        if zero is None:
            break
    closed = step_map.closed
    return Leading(None, Decision(None if closed is None else closed.preserves_volume()))


def telescoping_of(step_map: StepMap, first: int, defect: Leading) -> tuple[bool | None, str]:
    """Decide whether the leading coefficient of S telescopes; return its potential as a formula.

    It is decided for lieη in several degrees of freedom and for S ≡ 0, and undecided otherwise; for
    the plane see `verify.proof.plane.potential`.
    """
    eta = step_map.flow_up_to
    if step_map.hamiltonian.planar or eta < 1 or defect.power != eta + 1 or defect.form is None:
        is_zero = True if defect.decision.zero is True else None  # 0 is the derivative of 0
        return is_zero, "0" if is_zero else ""
    return telescopes_of_lie(series_of(step_map, first).flow, eta, defect.form)


# -- the order of the map -------------------------------------------------------------------------


def convergence_of(
    step_map: StepMap,
    first: int = FIRST_ORDERS,
    most: int = MOST_ORDERS,
    residues: bool = False,
) -> Convergence:
    """Return the order to which the map agrees with the exact flow.

    `residues`: True if differences as small as those of 90-digit coefficients count as 0.
    """
    order = step_map.known_order()
    if order is not None:
        # The next coefficient is shown to differ at a point, and is not computed.
        hamiltonian, difference = step_map.hamiltonian, f"the difference at h^{order + 1}"
        almost = (
            almost_all(hamiltonian.symbols, difference, hamiltonian.time_dependent)
            if hamiltonian.symbols
            else ""
        )
        return Convergence(
            order,
            True,
            lambda: FormulaDomain.from_requirements((), almost) if almost else EVERYWHERE,
        )
    series = series_of(step_map, first)
    closed = step_map.closed if step_map.formulas is not None and step_map.expand is None else None
    if closed is not None:  # all powers of a polynomial, and one more
        most = max(most, (most if closed.degree is None else closed.degree) + 1)
    return convergence_by(series, step_map.flow_up_to + 1, most, residues)


def convergence_by(series: AnySeries, begin: int, most: int, residues: bool = False) -> Convergence:
    """Return the order to which a map agrees with the exact flow, from h^begin … h^most."""
    for n in range(begin, most + 1):
        agrees, ring, residual = series.agrees(n, is_rounding_residual if residues else None)
        if agrees is not True:
            exact_for = partial(not_zero_for, ring, residual, f"the difference at h^{n}")
            return Convergence(n - 1, agrees is False, exact_for)
    return Convergence(None, True)


def convergence_of_scheme(
    step_map: StepMap,
    scheme: Scheme | None,
    first: int = FIRST_ORDERS,
    most: int = MOST_ORDERS,
) -> tuple[Convergence, NearbyOrder | None]:
    """Return the order of the map, as `convergence_of`, and that of exact coefficients near it.

    If exact coefficients near those that a scheme prints have a higher order, it is their order.
    """
    printed = convergence_of(step_map, first, most)
    hamiltonian = step_map.hamiltonian
    near = nearby_of_scheme(scheme, hamiltonian) if scheme else None
    if scheme is None or near is None or printed.order is None or near.order <= printed.order:
        return printed, None
    # A scheme without `every_h` is judged for this H, and so is the condition that ends its order.
    result = Convergence(near.order, scheme.every_h is None and near.wrong is not None)
    if near.parts:
        nearest = splitting(
            scheme.name,
            near.parts,
            order=near.order,
            symmetric=False,
            source=scheme.source,
            times=tuple(None if x is None else sympy.sympify(x) for x in near.times),
        )
        of_nearest = convergence_of(nearest.step_map(hamiltonian), most=most, residues=True)
        result = (
            of_nearest if of_nearest.order is None or of_nearest.order >= near.order else result
        )
    return result, near


def nearby_of_scheme(scheme: Scheme, hamiltonian: Hamiltonian) -> NearbyOrder | None:
    """Return the order of exact coefficients near those that the scheme prints.

    None if it prints none, or if exact ones near them have no order.
    """
    if scheme.formulas:
        return nearby_of_formulas(tuple(scheme.formulas.items()), hamiltonian)
    every_h = scheme.every_h
    timed = hamiltonian.time_dependent and isinstance(every_h, Splitting)
    return nearby_order(conditions_for(every_h) if timed else every_h, scheme.order)


def nearby_defect_of(
    scheme: Scheme | None, hamiltonian: Hamiltonian, power: int | None
) -> NearbyOrder | None:
    """Return the power of h up to which exact coefficients have no term in ΔJ, or S.

    They are near those printed in a user's formulas. None unless the term of h^power vanishes with
    them, so that it is caused by the rounding of the printed digits.
    """
    if scheme is None or not scheme.formulas or power is None:
        return None
    near = nearby_defect(tuple(scheme.formulas.items()), hamiltonian)
    return near if near is not None and near.order >= power else None


def with_nearby(
    judgement: tuple[Verdict, Prose],
    near: NearbyOrder | None,
    without: NearbyOrder | None,
    form: str,
) -> tuple[Verdict, Prose]:
    """Add to a verdict and its reason the properties of exact coefficients near printed ones.

    `near`: their higher order. `without`: the power of h up to which the defect, called `form`, has
    no term with them.
    """
    verdict, reason = judgement
    if near is not None and verdict is Verdict.PROVED:
        verdict, reason = near.verdict, prose(reason, "; ", describe_nearby(near))
    return verdict, reason if without is None else prose(
        reason, "; ", describe_nearby_defect(without, form)
    )


def is_rounding_residual(residual: Poly, term: Poly) -> bool:
    """Return True if the residual is as small as that of coefficients right to 90 digits."""
    return size_of(residual) < RESIDUAL * max(size_of(term), size_of(term - residual))


def size_of(x: Poly) -> Fraction:
    """Return the largest absolute coefficient."""
    return max((abs(Fraction(int(c.p), int(c.q))) for c in x.coeffs()), default=Fraction(0))
