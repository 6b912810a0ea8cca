"""The step of size h/c for c·H is the step of size h for H, for every c ≠ 0, negative ones too."""

from fractions import Fraction

from verify.equivariance import same_step
from verify.example import Example

_IDENTITY = (Fraction(1), Fraction(0)), (Fraction(0), Fraction(1))
_FACTORS = (Fraction(2), Fraction(-2, 3))


def holds(example: Example) -> bool:
    looked_at = [same_step(example, _IDENTITY, c, 1 / c) for c in _FACTORS]
    return all(looked_at)
