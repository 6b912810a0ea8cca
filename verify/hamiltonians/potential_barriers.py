"""Where many motions in one polynomial potential go, by the barriers on their way.

`verify.hamiltonians.potential_motion` finds it for one motion by exact algebra. Here the energies
of many are held against the potential's critical values, which are those of all; who is so near to
one that floats cannot tell is DoubtfulError.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import sympy

from verify.arithmetic.batch import Batch, DoubtfulError
from verify.arithmetic.float_context import WIDE

Array = Any  # numpy.ndarray
Rationals = Any  # a Batch of exact rationals
_NEAR = 2.0**-40  # of what an energy is summed from
_DIGITS = 40


def destinations(
    alpha: Fraction, potential: Sequence[Fraction], p: Rationals, q: Rationals, sign: int
) -> Batch:
    """1 or −1 where q goes to ±∞, forwards (sign 1) or backwards in time; 0 where it stays bounded.

    For H = α p²/2 + V(q), of points that are not at rest. Raises DoubtfulError.
    """
    import numpy as np

    values = [c / alpha for c in potential]  # V/α of a unit mass has the same orbits in q
    at, start = _float(q), _float(p)
    terms = [WIDE.rational(c) * at**k for k, c in enumerate(values)]
    pulls = [-k * WIDE.rational(c) * at ** (k - 1) for k, c in enumerate(values) if k]
    level, size = start**2 / 2 + sum(terms), start**2 / 2 + sum(map(abs, terms))
    force, resting = sum(pulls), start == 0
    doubt = resting & (abs(force) <= _NEAR * sum(map(abs, pulls)))
    towards: Array = np.sign(np.where(resting, force, sign * float(alpha) * start))
    turns, unclear = _barrier(values, at, level, size, towards)
    turns_back, unclear_back = _barrier(values, at, level, size, -towards)
    doubt |= unclear | (turns & ~resting & unclear_back)
    if doubt.any():
        raise DoubtfulError(doubt)
    stays = turns & (turns_back | resting)
    return Batch(np.where(stays, 0, np.where(turns, -towards, towards)).astype(int))


def _barrier(
    values: Sequence[Fraction], at: Array, level: Array, size: Array, side: Array
) -> tuple[Array, Array]:
    """Whether the motion turns on that side (1 or −1) of q, and whether that is doubtful."""
    import numpy as np

    turns = np.where(side > 0, *(_rises(values, s) for s in (1, -1))).astype(bool)
    doubt = np.zeros(len(at), bool)
    for critical in _critical(values):
        height = WIDE.rational(sum(c * critical**k for k, c in enumerate(values)))
        beyond = ((WIDE.rational(critical) - at) * side > 0) & ~turns
        doubt |= beyond & (abs(level - height) <= _NEAR * (size + abs(height)))
        turns |= beyond & (level < height)
    return turns, doubt


def _rises(values: Sequence[Fraction], side: int) -> bool:
    """Whether V does not fall without end on that side: c₁q falls, too."""
    top = next((k for k in range(len(values) - 1, 0, -1) if values[k]), 0)
    return top > 0 and values[top] * side**top > 0


def _critical(values: Sequence[Fraction]) -> list[Fraction]:
    """The real zeros of V', to many digits."""
    x = sympy.Symbol("x")
    slope = sum(sympy.Rational(k * c.numerator, c.denominator) * x ** (k - 1)
                for k, c in enumerate(values) if k)  # fmt: skip
    found = sympy.Poly(slope, x).real_roots(multiple=True) if slope.has(x) else []
    return [Fraction(str(root.evalf(_DIGITS))) for root in found]


def _float(x: Rationals) -> Array:
    return WIDE.rational(x).values
