"""Symplectic matrices with rational entries, as products of elementary ones, and permutations.

The elementary ones move z = (p1 … pn, q1 … qn) by a shear of p by q, or of q by p, with a symmetric
matrix; by q ← A q, p ← A⁻ᵀ p; or exchange a pair, p ← q, q ← −p.
"""

import random
from collections.abc import Callable, Sequence
from fractions import Fraction

import flint

Exact = flint.fmpq_mat
_NUMBERS = tuple(Fraction(n, d) for n, d in ((1, 2), (-1, 1), (2, 1), (-2, 3), (1, 3), (3, 2)))
_Elementary = Callable[[random.Random, int], Exact]


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
    """A product of two elementary matrices that the seed chooses, of different kinds."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    first, second = chance.sample([_shear_of_p, _shear_of_q, _of_places, _scaled, _pair], 2)
    return first(chance, degrees) * second(chance, degrees)


def of_places(seed: int, degrees: int) -> Exact:
    """One that moves q by q and p by p: q ← A q, p ← A⁻ᵀ p."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    return _of_places(chance, degrees) * _scaled(chance, degrees)


def cycled(degrees: int) -> Exact:
    """Each degree of freedom put in the place of the next, the last in that of the first."""
    found = Exact(2 * degrees, 2 * degrees)
    for k in range(degrees):
        for half in (0, degrees):
            found[half + (k + 1) % degrees, half + k] = flint.fmpq(1)
    return found


def exchanged(degrees: int) -> Exact:
    """p and q exchanged, for which MᵀΩM = −Ω."""
    found = Exact(2 * degrees, 2 * degrees)
    for k in range(degrees):
        found[k, degrees + k] = found[degrees + k, k] = flint.fmpq(1)
    return found


def _places(chance: random.Random, degrees: int) -> tuple[int, int]:
    i, j = chance.sample(range(degrees), 2)
    return i, j


def _shear(chance: random.Random, degrees: int, row: int, column: int) -> Exact:
    """The halves that begin at `row` sheared by those that begin at `column`."""
    i, j = _places(chance, degrees)
    found, by = identity(2 * degrees), exact(chance.choice(_NUMBERS))
    found[row + i, column + j] = found[row + j, column + i] = by
    return found


def _shear_of_p(chance: random.Random, degrees: int) -> Exact:
    return _shear(chance, degrees, 0, degrees)


def _shear_of_q(chance: random.Random, degrees: int) -> Exact:
    return _shear(chance, degrees, degrees, 0)


def _of_places(chance: random.Random, degrees: int) -> Exact:
    i, j = _places(chance, degrees)
    found, by = identity(2 * degrees), exact(chance.choice(_NUMBERS))
    found[degrees + i, degrees + j] = by
    found[j, i] = -by
    return found


def _scaled(chance: random.Random, degrees: int) -> Exact:
    factors = [chance.choice(_NUMBERS) for _ in range(degrees)]
    return diagonal([*(1 / x for x in factors), *factors])


def _pair(chance: random.Random, degrees: int) -> Exact:
    """p_k ← q_k, q_k ← −p_k of one degree of freedom."""
    found, k = identity(2 * degrees), chance.randrange(degrees)
    found[k, k] = found[degrees + k, degrees + k] = flint.fmpq(0)
    found[k, degrees + k], found[degrees + k, k] = flint.fmpq(1), flint.fmpq(-1)
    return found
