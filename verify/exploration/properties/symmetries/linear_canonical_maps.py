"""In other canonical coordinates M z, det M = 1, the step for H∘M⁻¹ is the image of that for H.

Schemes that step p and q by turns are asked for M that scales p and q only.
"""

from fractions import Fraction

from verify.exploration.oracles.equivariance import Change, knows_no_coordinates, must_be_same_steps
from verify.exploration.oracles.symplectic_matrices import (
    Exact,
    diagonal,
    exact,
    of_places,
    symplectic,
)
from verify.exploration.property import only_if
from verify.exploration.sample import Sample

_IN, _AFTER = 2, 1  # one in so many samples, and not those whose time is scaled
_SCALED = diagonal([Fraction(3, 2), Fraction(2, 3)])
_MIXED = Exact(2, 2, [exact(Fraction(x)) for x in ("2", "1/3", "3/2", "3/4")])


def holds(sample: Sample) -> None:
    """For S as a form: AᵀSA, A = M⁻¹."""
    only_if(sample.is_turn(_IN, _AFTER))
    must_be_same_steps(sample, Change(_matrix(sample)))


def _matrix(sample: Sample) -> Exact:
    """One of two in the plane, else a product of elementary symplectic matrices.

    Of schemes that step p and q by turns one that moves q by q, and p by p.
    """
    alike, degrees = knows_no_coordinates(sample), sample.hamiltonian.degrees
    if degrees == 1:
        return _MIXED if alike else _SCALED
    return (symplectic if alike else of_places)(sample.turn, degrees)
