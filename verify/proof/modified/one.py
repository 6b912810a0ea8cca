"""The modified Hamiltonian of a step map, term by term, for one H.

See `verify.proof.modified.field`. Each term is decided: its divergence is the zero function, and
then it is Hamiltonian; or a point shows that it is not, and no modified Hamiltonian reaches there.
The first divergence that is not 0 is held against the leading term of ΔJ, which is made from the
determinant of the map and shares no code with the terms.
"""

from collections.abc import Sequence

from verify.algebra.domain import Domain
from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.vector_field import VectorField
from verify.proof.expansion import MOST_ORDERS, Expansion, Leading
from verify.proof.modified.equation import ModifiedEquation, Term, judged
from verify.proof.modified.field import Vector, divergence, modified_field
from verify.proof.modified.hamiltonian_of_field import hamiltonian_of
from verify.proof.order import leading_of, nearby_of_scheme
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap

MOST_ORDER = 10


def modified_of(step_map: StepMap, scheme: Scheme | None, order: int) -> ModifiedEquation:
    """The terms up to h^order, 1 … 10, and what `scheme` claims held against them.

    Raises InputError where the map does not begin with (p, q) at h = 0, or is not smooth there.
    """
    source, p_next, q_next = _series(step_map, order + 1)
    ring = source.ring
    for name, first in zip(("p", "q"), (p_next[0], q_next[0]), strict=True):
        if ring.vanishes(first - ring.variable(name)) is not True:
            shown = str(step_map.hamiltonian.expression)
            problem = f"the map is not (p, q) at h = 0: {name}' is {ring.text(first)} there"
            raise InputError("map", shown, problem)
    vectors = modified_field(ring, p_next, q_next, source.timed)
    terms = [_term(source, j, vector, step_map.domain) for j, vector in enumerate(vectors)]
    found = ModifiedEquation(
        scheme=scheme.name if scheme else "the map",
        hamiltonian=step_map.hamiltonian.formula,
        order=order,
        terms=tuple(terms),
        consistent=_same(ring, vectors[0], (-source.h_q, source.h_p)),
        area=_area(step_map, terms),
        where=step_map.domain,
    )
    near = nearby_of_scheme(scheme, step_map.hamiltonian) if scheme else None
    return judged(found, scheme, near)


def _series(step_map: StepMap, most: int) -> tuple[VectorField, Sequence[Poly], Sequence[Poly]]:
    """The coefficients of h⁰ … h^most in p' and q', and the vector field in their ring."""
    series = step_map.taylor(most)
    if series is not None:
        source, p, q = series
        return source, p.coefficients, q.coefficients
    step = step_map.flat
    pairs = zip((step.p_next, step.q_next), step.terms or (None, None), strict=True)
    expansions = [Expansion(step.ring, x, terms) for x, terms in pairs]
    if most > MOST_ORDERS and not all(x.polynomial for x in expansions):
        raise InputError("order", most - 1, f"must be {MOST_ORDERS - 1} at most for this map")
    parts = [x.coefficient(n) for x in expansions for n in range(most + 1)]
    if all(ring is step.ring for ring, _ in parts):
        own = [x for _, x in parts]
        return step.field, own[: most + 1], own[most + 1 :]
    # Where h stands in a function each coefficient has a ring of its own; one holds them all.
    source, own = step_map.hamiltonian.field(*(ring.expression(x) for ring, x in parts))
    return source, own[: most + 1], own[most + 1 :]


def _term(source: VectorField, power: int, vector: Vector, domain: Domain) -> Term:
    """That of h^power in the field: its divergence decided, its energy looked for."""
    ring = source.ring
    turned = divergence(ring, vector)
    energy: Poly | None = ring.zero
    vanishes = _same(ring, vector, (ring.zero, ring.zero))
    if vanishes:
        vector = ring.zero, ring.zero
        decision = ring.decide(ring.zero)
    else:
        decision = ring.decide(turned)
        energy = hamiltonian_of(source, vector, power + 1) if decision.zero else None
    element = None if decision.zero else (ring, turned)
    leading = Leading(None if decision.zero else power, decision, element).within(domain)
    return Term(
        power=power,
        p=ring.text(vector[0]),
        q=ring.text(vector[1]),
        hamiltonian=None if energy is None else ring.text(energy),
        vanishes=vanishes,
        is_hamiltonian=leading.decision.zero,
        divergence=leading.text,
        witness=leading.decision.witness,
        enclosure=leading.decision.enclosure,
        domain=leading.domain,
        energy=None if energy is None else (ring, energy),
        found=(ring, turned),
    )


def _same(ring: Ring, vector: Vector, other: Vector) -> bool | None:
    """Whether two fields are the same; None where that is not decided."""
    found = {ring.vanishes(x - y) for x, y in zip(vector, other, strict=True)}
    return False if False in found else None if None in found else True


def _area(step_map: StepMap, terms: Sequence[Term]) -> bool | None:
    """Whether the first divergence is the leading coefficient of ΔJ; None where neither is known.

    Of a field whose terms are all Hamiltonian: whether ΔJ vanishes as far as they tell.
    """
    first = next((x for x in terms if x.is_hamiltonian is not True), None)
    leading = leading_of(step_map)
    if leading.decision.zero is None or (first is not None and first.is_hamiltonian is None):
        return None
    if first is None:
        return leading.decision.zero or leading.power is None or leading.power > len(terms)
    if leading.power != first.power + 1 or leading.element is None or first.found is None:
        return False
    (ring, x), (other, y) = first.found, leading.element
    if ring is other:
        return ring.vanishes(x - y)
    gap = ring.expression(x) - other.expression(y)
    common, (difference,) = embed([gap], ring.variables)
    return common.vanishes(difference)
