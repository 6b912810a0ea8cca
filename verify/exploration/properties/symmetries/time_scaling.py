"""The step of size h/c for c·H is the step of size h for H, for every c ≠ 0, negative ones too.

Looked at for one c, that is negative and no power of two.
"""

from fractions import Fraction

from verify.exploration.equivariance import must_be_same_step
from verify.exploration.property import only_if
from verify.exploration.sample import Sample

_IN = 2  # one in so many samples
_IDENTITY = (Fraction(1), Fraction(0)), (Fraction(0), Fraction(1))
_FACTOR = Fraction(-2, 3)


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN))
    must_be_same_step(sample, _IDENTITY, _FACTOR, 1 / _FACTOR)
