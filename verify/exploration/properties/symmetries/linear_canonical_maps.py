"""In other canonical coordinates M z, det M = 1, the step for H∘M⁻¹ is the image of that for H.

Schemes that step p and q by turns are asked for M that scales p and q only.
"""

from fractions import Fraction

from verify.exploration.degrees import equivariance as several
from verify.exploration.degrees.symplectic_matrices import of_places, symplectic
from verify.exploration.equivariance import Change, knows_no_coordinates, must_be_same_step
from verify.exploration.property import only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_IN, _AFTER = 2, 1  # one in so many samples, and not those whose time is scaled
_SCALED = (Fraction(3, 2), Fraction(0)), (Fraction(0), Fraction(2, 3))
_MIXED = (Fraction(2), Fraction(1, 3)), (Fraction(3, 2), Fraction(3, 4))


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN, _AFTER))
    must_be_same_step(sample, Change(_MIXED if knows_no_coordinates(sample) else _SCALED))


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """For a product M of elementary symplectic matrices, and S as a form: AᵀSA, A = M⁻¹.

    Of schemes that step p and q by turns for M that moves q by q, and p by p.
    """
    only_if(sample.is_turn(_IN, _AFTER))
    make = symplectic if several.knows_no_coordinates(sample) else of_places
    change = several.Change(make(sample.turn, sample.hamiltonian.degrees))
    several.must_be_same_steps(sample, change)
