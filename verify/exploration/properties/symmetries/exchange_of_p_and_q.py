"""With p and q exchanged, the step for −H(q, p) is that for H(p, q) with p' and q' exchanged.

Asked of schemes that treat p and q alike.
"""

from fractions import Fraction

from verify.exploration.degrees import equivariance as several
from verify.exploration.degrees.symplectic_matrices import exchanged
from verify.exploration.equivariance import Change, knows_no_coordinates, must_be_same_step
from verify.exploration.property import only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_IN = 2  # one in so many samples
_EXCHANGED = (Fraction(0), Fraction(1)), (Fraction(1), Fraction(0))


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN) and knows_no_coordinates(sample))
    must_be_same_step(sample, Change(_EXCHANGED, Fraction(-1)))


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """All of p with all of q."""
    only_if(sample.is_turn(_IN) and several.knows_no_coordinates(sample))
    every = exchanged(sample.hamiltonian.degrees)
    several.must_be_same_steps(sample, several.Change(every, Fraction(-1)))
