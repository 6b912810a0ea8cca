"""The step of size h/c for c·H is the step of size h for H, for every c ≠ 0, negative ones too.

Looked at for one c, that is negative and no power of two. Where H depends on time, what it is at t
c·H is at t/c.
"""

from fractions import Fraction

from verify.exploration.degrees import equivariance as several
from verify.exploration.degrees.symplectic_matrices import identity
from verify.exploration.equivariance import Change, must_be_same_step
from verify.exploration.property import only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_IN = 2  # one in so many samples
_FACTOR = Fraction(-2, 3)


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN))
    must_be_same_step(sample, Change(factor=_FACTOR, pace=1 / _FACTOR))


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same for S."""
    only_if(sample.is_turn(_IN))
    same = identity(2 * sample.hamiltonian.degrees)
    change = several.Change(same, factor=_FACTOR, pace=1 / _FACTOR)
    several.must_be_same_steps(sample, change)
