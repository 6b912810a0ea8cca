"""With H and t₀ shifted together the step is the same: a clock has no zero of its own."""

from fractions import Fraction

from verify.exploration.equivariance import CoordinateChange, identity, must_be_same_steps
from verify.exploration.property import only_if
from verify.exploration.sample import Sample

_SHIFT = Fraction(-5, 3)


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=2, after=1))  # not those whose time is scaled
    unit_matrix = identity(2 * sample.hamiltonian.degrees)
    must_be_same_steps(sample, CoordinateChange(unit_matrix, shift=_SHIFT))
