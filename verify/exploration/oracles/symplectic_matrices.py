"""Symplectic matrices with rational entries, as products of elementary ones, and permutations.

The elementary ones move z = (p1 … pn, q1 … qn) by a shear of p by q, or of q by p, with a symmetric
matrix; by q ← A q, p ← A⁻ᵀ p; or exchange a pair, p ← q, q ← −p.
"""

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction

import flint

Exact = flint.fmpq_mat
_NUMBERS = tuple(Fraction(n, d) for n, d in ((1, 2), (-1, 1), (2, 1), (-2, 3), (1, 3), (3, 2)))


def exact(x: Fraction) -> flint.fmpq:
    """A rational as flint's."""
    return flint.fmpq(x.numerator, x.denominator)


def identity(size: int) -> Exact:
    """The matrix 1."""
    return diagonal([Fraction(1)] * size)


def diagonal(values: Sequence[Fraction]) -> Exact:
    """The matrix with these on its diagonal."""
    size = range(len(values))
    return Exact([[exact(values[a]) if a == b else 0 for b in size] for a in size])


def symplectic(seed: int, degrees: int) -> Exact:
    """A product of two elementary matrices that the seed chooses, of different kinds; in the plane
    of two shears, which mix p and q."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _shear_of_p(chance, degrees) * _shear_of_q(chance, degrees)
    first, second = chance.sample([_shear_of_p, _shear_of_q, _of_places, _scaled, _pair], 2)
    return first(chance, degrees) * second(chance, degrees)


def of_places(seed: int, degrees: int) -> Exact:
    """One that moves q by q and p by p: q ← A q, p ← A⁻ᵀ p."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _scaled(chance, degrees)
    return _of_places(chance, degrees) * _scaled(chance, degrees)


def cycled(degrees: int) -> Exact:
    """Each degree of freedom put in the place of the next, the last in that of the first."""
    before = [(k - 1) % degrees for k in range(degrees)]
    return _permuted([*before, *(degrees + k for k in before)])


def exchanged(degrees: int) -> Exact:
    """p and q exchanged, for which MᵀΩM = −Ω."""
    return _permuted([*range(degrees, 2 * degrees), *range(degrees)])


def _permuted(places: Sequence[int]) -> Exact:
    """The matrix that takes each coordinate from one of these places."""
    return Exact([[int(a == place) for a in range(len(places))] for place in places])


def _changed(degrees: int, entries: Mapping[tuple[int, int], Fraction | int]) -> Exact:
    """The matrix 1 with these entries in place of its own."""
    matrix = identity(2 * degrees)
    for place, x in entries.items():
        matrix[place] = exact(Fraction(x))
    return matrix


def _pair_and_number(chance: random.Random, degrees: int) -> tuple[int, int, Fraction]:
    """Two degrees of freedom, the same one in the plane, and a number."""
    i, j = chance.sample(range(degrees), 2) if degrees > 1 else (0, 0)
    return i, j, chance.choice(_NUMBERS)


def _shear_of_p(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _changed(n, {(i, n + j): x, (j, n + i): x})


def _shear_of_q(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _changed(n, {(n + i, j): x, (n + j, i): x})


def _of_places(chance: random.Random, n: int) -> Exact:
    i, j, x = _pair_and_number(chance, n)
    return _changed(n, {(n + i, n + j): x, (j, i): -x})


def _scaled(chance: random.Random, degrees: int) -> Exact:
    factors = [chance.choice(_NUMBERS) for _ in range(degrees)]
    return diagonal([*(1 / x for x in factors), *factors])


def _pair(chance: random.Random, n: int) -> Exact:
    """p_k ← q_k, q_k ← −p_k of one degree of freedom."""
    k = chance.randrange(n)
    return _changed(n, {(k, k): 0, (n + k, n + k): 0, (k, n + k): 1, (n + k, k): -1})
