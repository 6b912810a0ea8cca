"""In other canonical coordinates M z, det M = 1, the step for H∘M⁻¹ is the image of that for H.

For schemes that advance p and q in turn, M only scales p and q.
"""

from verify.exploration.equivariance import (
    CoordinateChange,
    coordinate_change,
    knows_no_coordinates,
    must_be_same_steps,
    symplectic,
)
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    """Compare the steps in both coordinate systems; the form S becomes AᵀSA, A = M⁻¹.

    For schemes that advance q and p in turn, M must not mix q and p.
    """
    only_if(sample.is_turn(one_in=2, after=1))  # `time_scaling` tests the others
    matrix = symplectic if knows_no_coordinates(sample) else coordinate_change
    must_be_same_steps(sample, CoordinateChange(matrix(sample.turn, sample.hamiltonian.degrees)))
