"""The step of size h/c for c·H is the step of size h for H, for every c ≠ 0, negative ones too.

One c is tested, which is negative and no power of two. If H depends on time, the scaled H at t/c is
c times H at t.
"""

from fractions import Fraction

from verify.exploration.equivariance import CoordinateChange, identity, must_be_same_steps
from verify.exploration.property import only_if
from verify.exploration.sample import Sample

_FACTOR = Fraction(-2, 3)


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=2))
    unit_matrix = identity(2 * sample.hamiltonian.degrees)
    must_be_same_steps(sample, CoordinateChange(unit_matrix, factor=_FACTOR, pace=1 / _FACTOR))
