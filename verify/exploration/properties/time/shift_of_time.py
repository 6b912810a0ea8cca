"""With H and t₀ shifted together the step is the same: a clock has no zero of its own."""

from fractions import Fraction

from verify.exploration.oracles.equivariance import Change, must_be_same_steps
from verify.exploration.oracles.symplectic_matrices import identity
from verify.exploration.property import only_if
from verify.exploration.sample import Sample

_IN, _AFTER = 2, 1  # one in so many samples, and not those whose time is scaled
_SHIFT = Fraction(-5, 3)


def holds(sample: Sample) -> None:
    only_if(sample.timed and sample.is_turn(_IN, _AFTER))
    same = identity(2 * sample.hamiltonian.degrees)
    must_be_same_steps(sample, Change(same, shift=_SHIFT))
