"""Symplectic matrices with rational entries, as products of elementary ones, and permutations.

The elementary ones move z = (p1 … pn, q1 … qn) by a shear of p by q, or of q by p, with a symmetric
matrix; by q ← A q, p ← A⁻ᵀ p; or exchange a pair, p ← q, q ← −p.
"""

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction

import flint

Exact = flint.fmpq_mat
# Numbers of few digits keep the coefficients of the transformed H short.
_NUMBERS = tuple(Fraction(n, d) for n, d in ((1, 2), (-1, 1), (2, 1), (-2, 3), (1, 3), (3, 2)))


def exact(x: Fraction) -> flint.fmpq:
    """Convert a rational to flint's."""
    return flint.fmpq(x.numerator, x.denominator)


def identity(size: int) -> Exact:
    """Return the identity matrix."""
    return diagonal([Fraction(1)] * size)


def diagonal(values: Sequence[Fraction]) -> Exact:
    """Return the matrix with these values on its diagonal."""
    size = range(len(values))
    return Exact([[exact(values[a]) if a == b else 0 for b in size] for a in size])


def symplectic(seed: int, degrees: int) -> Exact:
    """Return a product of two elementary matrices of different kinds, chosen by the seed.

    In the plane it is a product of two shears, which mix q and p.
    """
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _shear_of_p(chance, degrees) * _shear_of_q(chance, degrees)
    # In n degrees a product of two kinds is general enough, and keeps H short.
    first, second = chance.sample([_shear_of_p, _shear_of_q, _coordinate_shear, _scaling, _pair], 2)
    return first(chance, degrees) * second(chance, degrees)


def coordinate_change(seed: int, degrees: int) -> Exact:
    """Return a matrix that does not mix q and p: q ← A q, p ← A⁻ᵀ p."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _scaling(chance, degrees)
    return _coordinate_shear(chance, degrees) * _scaling(chance, degrees)


def cyclic_shift(degrees: int) -> Exact:
    """Return the permutation that moves each degree of freedom to the next one, cyclically."""
    before = [(k - 1) % degrees for k in range(degrees)]
    return _permutation([*before, *(degrees + k for k in before)])


def exchange_of_p_and_q(degrees: int) -> Exact:
    """Return the exchange of q and p, for which MᵀΩM = −Ω."""
    return _permutation([*range(degrees, 2 * degrees), *range(degrees)])


def _permutation(places: Sequence[int]) -> Exact:
    """Return the matrix that takes each coordinate from one of these places."""
    return Exact([[int(a == place) for a in range(len(places))] for place in places])


def _identity_with(degrees: int, entries: Mapping[tuple[int, int], Fraction | int]) -> Exact:
    """Return the identity matrix with these entries replaced."""
    matrix = identity(2 * degrees)
    for place, x in entries.items():
        matrix[place] = exact(Fraction(x))
    return matrix


def _pair_and_number(chance: random.Random, degrees: int) -> tuple[int, int, Fraction]:
    """Choose two degrees of freedom (the same one twice in the plane) and a number."""
    i, j = chance.sample(range(degrees), 2) if degrees > 1 else (0, 0)
    return i, j, chance.choice(_NUMBERS)


def _shear_of_p(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(i, n + j): x, (j, n + i): x})


def _shear_of_q(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(n + i, j): x, (n + j, i): x})


def _coordinate_shear(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(n + i, n + j): x, (j, i): -x})


def _scaling(chance: random.Random, degrees: int) -> Exact:
    factors = [chance.choice(_NUMBERS) for _ in range(degrees)]
    return diagonal([*(1 / x for x in factors), *factors])


def _pair(chance: random.Random, n: int) -> Exact:
    """Return the exchange p_k ← q_k, q_k ← −p_k in one degree of freedom."""
    k = chance.randrange(n)
    return _identity_with(n, {(k, k): 0, (n + k, n + k): 0, (k, n + k): 1, (n + k, k): -1})
