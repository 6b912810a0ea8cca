"""The modified Hamiltonian of a step map, term by term, for one H.

See `verify.proof.plane.modified_terms`. For each term it is decided whether its divergence is the
zero function: then the term is Hamiltonian. Otherwise a point shows that it is not, and there is no
modified Hamiltonian with this term. The first divergence that is not 0 is compared with the leading
term of ΔJ, which other code computes from the determinant of the map.

A field with divergence 0 is on every disc the Hamiltonian vector field (−∂G/∂q, ∂G/∂p) of some
function G. Three searches for a closed form follow one another:
- if the field is polynomial in p and q, integration term by term, which always succeeds;
- among the products of k derivatives of H with k − 1 derivatives by p and by q each: the modified
  Hamiltonians of Runge–Kutta methods and splittings are made of those, whatever H is (Hairer,
  Lubich, Wanner, IX.9; for splittings they are Poisson brackets of T and V). With time a product
  may have fewer factors, and as many derivatives by t in place of them;
- among the polynomials in the generators of H and the field, for a user's own maps.
A candidate is compared with the field in the ring; if none is found, nothing is claimed.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import product

from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import Index, Jets
from verify.algebra.linear_algebra import solve_combination
from verify.algebra.power_series import CoefficientRing, Derivatives
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, require_canonical
from verify.proof.expansion import MOST_ORDERS, ClosedSeries
from verify.proof.order_for_one_h import leading_of, nearby_of_scheme
from verify.proof.plane.modified_equation import ModifiedEquation, judge_equation
from verify.proof.plane.modified_terms import TermEnergy, Vector, build_equation, field_of
from verify.proof.plane.potential import among_polynomials
from verify.proof.telescoping import multisets
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme

MOST_ORDER = 10
_MOST_PRODUCTS, _MOST_IN_TIME = 400, 2000  # limits of the products of derivatives of H


def modified_for_one_h(step_map: StepMap, scheme: Scheme | None, order: int) -> ModifiedEquation:
    """Compute the modified equation up to h^order, 1 … 10, and judge what `scheme` claims.

    Raises InputError if the map does not begin with (p, q) at h = 0, or is not smooth there.
    """
    step_map.hamiltonian.check_planar()
    source, p_next, q_next = _series(step_map, order + 1)
    ring = source.ring
    for name, first in zip(("p", "q"), (p_next[0], q_next[0]), strict=True):
        if ring.vanishes(first - ring.variable(name)) is not True:
            formula = str(step_map.hamiltonian.expression)
            problem = f"the map is not (p, q) at h = 0: {name}' is {ring.text(first)} there"
            raise InputError("map", formula, problem)

    def energy_of(vector: Vector, factors: int) -> TermEnergy | None:
        function = hamiltonian_of(source, vector, factors) if any(vector) else ring.zero
        return None if function is None else TermEnergy(ring.text(function), (ring, function))

    equation = build_equation(
        source,
        (p_next, q_next),
        leading_of(step_map),
        energy_of,
        scheme=scheme.name if scheme else "the map",
        hamiltonian=step_map.hamiltonian.formula,
        domain=step_map.domain,
    )
    near = nearby_of_scheme(scheme, step_map.hamiltonian) if scheme else None
    return judge_equation(equation, scheme, near)


def _series(step_map: StepMap, most: int) -> tuple[CanonicalField, Sequence[Poly], Sequence[Poly]]:
    """Return the vector field, and the coefficients of h⁰ … h^most in p' and q' in its ring."""
    series = step_map.series(most)
    if series is not None:
        source, (p, q) = series
        return require_canonical(source), p.coefficients, q.coefficients
    closed = ClosedSeries(step_map.flat)
    if most > MOST_ORDERS and not closed.polynomial:
        raise InputError("order", most - 1, f"must be {MOST_ORDERS - 1} at most for this map")
    source, (p_next, q_next), _ = closed.in_one_field(step_map.hamiltonian, most)
    return require_canonical(source), p_next, q_next


# -- the search for G -----------------------------------------------------------------------------


def hamiltonian_of(field: CanonicalField, vector: Vector, factors: int) -> Poly | None:
    """Find G for one H; None if none is found.

    `factors`: the number of derivatives of H in each product of the field, if the scheme is one for
    every H.
    """
    ring = field.ring
    for way in (_by_integration, _among_products, _among_all):
        candidate = way(field, vector, factors)
        if candidate is not None and _is_hamiltonian_of(ring, candidate, vector):
            return candidate
    return None


def hamiltonian_in_jets(jets: Jets, vector: Vector, factors: int) -> Poly | None:
    """Find G for every H, a polynomial in its derivatives; None if there is none.

    The derivatives are free, so that those in G are of lower order than the highest in the field.
    """
    degrees = [n for x in vector for n in _orders(jets, x)]
    indices = [index for index in jets.indices if sum(index) < max(degrees, default=1)]
    chosen = multisets(indices, factors, factors - 1, factors - 1)
    # p itself occurs in no term, so that it can mark the second component of a field.
    return _find_combination(jets, list(map(jets.product, chosen)), vector, jets.p)


def _orders(jets: Jets, x: Poly) -> Iterator[int]:
    """Yield i + j for the derivatives H_ij that occur in x."""
    degrees = x.degrees()[2:]
    yield from (i + j for (i, j), n in zip(jets.indices, degrees, strict=True) if n > 0)


def _combine_parts(mark: Poly, vector: Vector) -> Poly:
    """Combine both components in one element; `mark` is a variable that occurs in neither."""
    return vector[0] + mark * vector[1]


def _is_hamiltonian_of(ring: Ring, candidate: Poly, vector: Vector) -> bool:
    pairs = zip(field_of(ring, candidate), vector, strict=True)
    return all(ring.vanishes(y - x) is True for y, x in pairs)


# -- searches for one H: each returns a candidate G or None ---------------------------------------


def _by_integration(field: CanonicalField, vector: Vector, _: int) -> Poly | None:
    """Return G = ∫ q' dp + ∫ (the rest of −p') dq; None if p or q stands within a function."""
    ring = field.ring
    gens = ring.context.gens()
    functions = [g.index for g in ring.generators_in(*vector) if g.kind != "variable"]
    if any(ring.depends(gens[k], name) for k in functions for name in ("p", "q")):
        return None
    # q' = ∂G/∂p and p' = −∂G/∂q: after G has been integrated in p, the rest depends on q alone.
    by_p = vector[1].integral(ring.places["p"])
    remaining = ring.reduce(-vector[0] - ring.diff(by_p, "q"))
    return ring.reduce(by_p + remaining.integral(ring.places["q"]))


def _among_products(field: CanonicalField, vector: Vector, factors: int) -> Poly | None:
    ring, energy = field.ring, field.energy
    if factors < 2:
        return energy
    jets = Jets(factors - 1, separable=field.separable)
    plain = multisets(jets.indices, factors, factors - 1, factors - 1)
    names = [*([(*each, 0) for each in chosen] for chosen in plain)]
    if field.timed:
        names += _products_in_time(jets.indices, factors)
    if len(names) > (_MOST_IN_TIME if field.timed else _MOST_PRODUCTS):
        return None
    in_time = [energy]
    for _ in range(factors - 1 if field.timed else 0):
        in_time.append(ring.diff(in_time[-1], "t"))
    partial = [Derivatives(ring, x).partial for x in in_time]
    products = [_product(ring, [partial[k](i, j) for i, j, k in chosen]) for chosen in names]
    numbers = _numbers_in(ring, vector)
    candidates = [ring.multiply(c, m) for c in numbers for m in products if not m.is_zero()]
    # h occurs in no coefficient of a series in h, so that it can be the mark.
    return _find_combination(ring, candidates, vector, ring.variable("h"))


def _products_in_time(
    indices: Sequence[Index], factors: int
) -> Iterator[list[tuple[int, int, int]]]:
    """Yield products of m < `factors` derivatives of H.

    They have m − 1 derivatives by p, m − 1 by q and `factors` − m by t in all.
    """
    for m in range(1, factors):
        for chosen in multisets([(0, 0), *indices], m, m - 1, m - 1):
            shares = product(range(factors - m + 1), repeat=m)
            products = (
                tuple(sorted((i, j, k) for (i, j), k in zip(chosen, share, strict=True)))
                for share in shares
                if sum(share) == factors - m
            )
            yield from (list(each) for each in set(products) if (0, 0, 0) not in each)


def _product(ring: Ring, parts: Sequence[Poly]) -> Poly:
    total = ring.one
    for part in parts:
        total = ring.multiply(total, part)
    return total


def _find_combination(
    ring: CoefficientRing, candidates: Sequence[Poly], vector: Vector, mark: Poly
) -> Poly | None:
    """Find a linear combination of the candidates with this field; see `_combine_parts`."""
    columns = [_combine_parts(mark, field_of(ring, m)) for m in candidates]
    coefficients, _ = solve_combination(columns, _combine_parts(mark, vector))
    if coefficients is None:
        return None
    return sum((c * candidates[k] for k, c in coefficients.items()), ring.zero)


def _numbers_in(ring: Ring, vector: Vector) -> list[Poly]:
    """Return 1 and the products of irrational numbers, such as ∛2, that occur in terms."""
    gens = ring.context.gens()
    indices = [g.index for g in ring.generators_in(*vector) if g.kind != "variable"]
    numbers = [k for k in indices if not any(ring.depends(gens[k], n) for n in ring.variables)]
    exponents = {tuple(0 for _ in numbers)}
    for x in vector:
        exponents |= {tuple(int(monomial[k]) for k in numbers) for monomial, _ in terms_of(x)}
    return [
        math.prod((gens[k] ** n for k, n in zip(numbers, powers, strict=True)), start=ring.one)
        for powers in sorted(exponents)
    ]


def _among_all(field: CanonicalField, vector: Vector, _: int) -> Poly | None:
    ring, mark = field.ring, field.ring.variable("h")

    def derive(x: Poly) -> Poly:
        return _combine_parts(mark, field_of(ring, x))

    derivatives = [ring.diff(x, name) for x in vector for name in ("p", "q")]
    elements = (field.energy, *vector, *derivatives)  # derivatives of sin have its integral, cos
    return among_polynomials(ring, elements, derive, _combine_parts(mark, vector))
