"""The function G whose Hamiltonian vector field (−∂G/∂q, ∂G/∂p) is a given one, where one is found.

A field with divergence 0 has such a G on every disc. It is looked for in closed form:
- in p and q as polynomials: by integrating term by term, which finds it always;
- among the products of k derivatives of H with k − 1 derivatives by p and by q each: the modified
  Hamiltonians of Runge–Kutta methods and splittings are made of those, whatever H is (Hairer,
  Lubich, Wanner, IX.9; of splittings they are Poisson brackets of T and V); in time a factor less
  may be a derivative by t more;
- among the polynomials in what H and the field are made of, for maps of a user's own.
What is found is held against the field in the ring; what is not found is not denied.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import product

from verify.algebra.generator import terms_of
from verify.algebra.linear_combination import combination
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.jets import Jets
from verify.algebra.series.jets_in_degrees import Index
from verify.algebra.series.power_series import partials
from verify.hamiltonians.vector_field import VectorField
from verify.proof.modified.field import Vector, field_of
from verify.proof.potential import among_polynomials
from verify.proof.telescoping import multisets

_MOST_PRODUCTS, _MOST_IN_TIME = 400, 2000  # tried in the second way


def hamiltonian_of(field: VectorField, vector: Vector, factors: int) -> Poly | None:
    """G for one H; None where none is found. `factors`: how many derivatives of H are multiplied
    in each term of the vector field, of a scheme for every H.
    """
    ring = field.ring
    for way in (_by_integration, _among_products, _among_all):
        found = way(field, vector, factors)
        if found is not None and _is_hamiltonian_of(ring, found, vector):
            return found
    return None


def hamiltonian_in_jets(jets: Jets, vector: Vector, factors: int) -> Poly | None:
    """G for every H, a polynomial in its derivatives; None where there is none.

    H_11 … are free, so that the highest derivative in G is of one order less than in the field.
    """
    degrees = [n for x in vector for n in _orders(jets, x)]
    products = list(_products(jets, factors, max(degrees, default=1) - 1))
    # p itself occurs in no term, and keeps the two parts of a field apart.
    columns = [_joined(jets.p, field_of(jets, m)) for m in products]
    found, _ = combination(columns, _joined(jets.p, vector))
    if found is None:
        return None
    return sum((c * products[k] for k, c in found.items()), jets.zero)


def _orders(jets: Jets, x: Poly) -> Iterator[int]:
    """i + j of the derivatives H_ij that occur in x."""
    degrees = x.degrees()[2:]
    yield from (i + j for (i, j), n in zip(jets.indices, degrees, strict=True) if n > 0)


def _products(jets: Jets, factors: int, highest: int) -> Iterator[Poly]:
    """Those of so many derivatives, with one less by p and by q each."""
    indices = [index for index in jets.indices if sum(index) <= highest]
    for chosen in multisets(indices, factors, factors - 1, factors - 1):
        yield math.prod((jets.h(i, j) for i, j in chosen), start=jets.one)


def _joined(mark: Poly, vector: Vector) -> Poly:
    """Both parts in one element, by a variable that does not occur in them."""
    return vector[0] + mark * vector[1]


def _is_hamiltonian_of(ring: Ring, found: Poly, vector: Vector) -> bool:
    pairs = zip(field_of(ring, found), vector, strict=True)
    return all(ring.vanishes(own - x) is True for own, x in pairs)


# -- for one H: each way gives a G, or None; the caller checks it ---------------------------------


def _by_integration(field: VectorField, vector: Vector, _: int) -> Poly | None:
    """G = ∫ q' dp + ∫ (what is left of −p') dq, where p and q stand in no function."""
    ring = field.ring
    gens = ring.context.gens()
    functions = [g.index for g in ring.generators_in(*vector) if g.kind != "variable"]
    if any(ring.depends(gens[k], name) for k in functions for name in ("p", "q")):
        return None
    by_p = vector[1].integral(ring.places["p"])
    left = ring.reduce(-vector[0] - ring.diff(by_p, "q"))
    return ring.reduce(by_p + left.integral(ring.places["q"]))


def _among_products(field: VectorField, vector: Vector, factors: int) -> Poly | None:
    ring, energy = field.ring, field.of_energy
    if factors < 2 or energy is None:
        return energy
    jets = Jets(factors - 1, separable=field.separable())
    plain = multisets(jets.indices, factors, factors - 1, factors - 1)
    names = [*([(*each, 0) for each in chosen] for chosen in plain)]
    if field.timed:
        names += _products_in_time(jets.indices, factors)
    if len(names) > (_MOST_IN_TIME if field.timed else _MOST_PRODUCTS):
        return None
    in_time = [energy]
    for _ in range(factors - 1 if field.timed else 0):
        in_time.append(ring.diff(in_time[-1], "t"))
    partial = [partials(ring, x) for x in in_time]
    products = [_product(ring, [partial[k](i, j) for i, j, k in chosen]) for chosen in names]
    numbers = _numbers_in(ring, vector)
    candidates = [ring.multiply(c, m) for c in numbers for m in products if not m.is_zero()]
    return _combined(ring, candidates, vector)


def _products_in_time(
    indices: Sequence[Index], factors: int
) -> Iterator[list[tuple[int, int, int]]]:
    """Of m < `factors` derivatives of H, m − 1 by p and by q, and `factors` − m by t."""
    for m in range(1, factors):
        for chosen in multisets([(0, 0), *indices], m, m - 1, m - 1):
            shares = product(range(factors - m + 1), repeat=m)
            made = (
                tuple(sorted((i, j, k) for (i, j), k in zip(chosen, share, strict=True)))
                for share in shares
                if sum(share) == factors - m
            )
            yield from (list(each) for each in set(made) if (0, 0, 0) not in each)


def _product(ring: Ring, parts: Sequence[Poly]) -> Poly:
    total = ring.one
    for part in parts:
        total = ring.multiply(total, part)
    return total


def _combined(ring: Ring, candidates: Sequence[Poly], vector: Vector) -> Poly | None:
    mark = ring.variable("h")  # which is in no coefficient of a series in h
    columns = [_joined(mark, field_of(ring, m)) for m in candidates]
    found, _ = combination(columns, _joined(mark, vector))
    if found is None:
        return None
    return sum((c * candidates[k] for k, c in found.items()), ring.zero)


def _numbers_in(ring: Ring, vector: Vector) -> list[Poly]:
    """The products of irrational numbers that are factors of terms, such as ∛2; 1 is one."""
    gens = ring.context.gens()
    used = [g.index for g in ring.generators_in(*vector) if g.kind != "variable"]
    numbers = [k for k in used if not any(ring.depends(gens[k], n) for n in ring.variables)]
    found = {tuple(0 for _ in numbers)}
    for x in vector:
        found |= {tuple(int(monomial[k]) for k in numbers) for monomial, _ in terms_of(x)}
    return [
        math.prod((gens[k] ** n for k, n in zip(numbers, powers, strict=True)), start=ring.one)
        for powers in sorted(found)
    ]


def _among_all(field: VectorField, vector: Vector, _: int) -> Poly | None:
    ring, mark = field.ring, field.ring.variable("h")

    def derive(x: Poly) -> Poly:
        return _joined(mark, field_of(ring, x))

    derivatives = [ring.diff(x, name) for x in vector for name in ("p", "q")]
    used = (field.of_energy or ring.zero, *vector, *derivatives)  # sin has cos for its integral
    return among_polynomials(ring, used, derive, _joined(mark, vector))
