"""With H and t₀ shifted together the step is the same: a clock has no zero of its own."""

from fractions import Fraction

from verify.exploration.degrees import equivariance as several
from verify.exploration.degrees.symplectic_matrices import identity
from verify.exploration.equivariance import Change, must_be_same_step
from verify.exploration.property import only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_IN, _AFTER = 2, 1  # one in so many samples, and not those whose time is scaled
_SHIFT = Fraction(-5, 3)


def holds(sample: Sample) -> None:
    only_if(sample.timed and sample.is_turn(_IN, _AFTER))
    must_be_same_step(sample, Change(shift=_SHIFT))


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same for S."""
    only_if(sample.timed and sample.is_turn(_IN, _AFTER))
    same = identity(2 * sample.hamiltonian.degrees)
    several.must_be_same_steps(sample, several.Change(same, shift=_SHIFT))
