"""In other canonical coordinates M z, det M = 1, the step for H∘M⁻¹ is the image of that for H.

Schemes that step p and q by turns are asked for M that scales p and q only.
"""

from verify.exploration.oracles.equivariance import Change, knows_no_coordinates, must_be_same_steps
from verify.exploration.oracles.symplectic_matrices import of_places, symplectic
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    """For S as a form: AᵀSA, A = M⁻¹; of schemes that step p and q by turns for an M that moves q
    by q, and p by p."""
    only_if(sample.is_turn(one_in=2, after=1))  # not those whose time is scaled
    matrix = symplectic if knows_no_coordinates(sample) else of_places
    must_be_same_steps(sample, Change(matrix(sample.turn, sample.hamiltonian.degrees)))
