"""With p and q exchanged, the step for −H(q, p) is that for H(p, q) with p' and q' exchanged.

Asked of schemes that treat p and q alike.
"""

from fractions import Fraction

from verify.exploration.oracles.equivariance import Change, knows_no_coordinates, must_be_same_steps
from verify.exploration.oracles.symplectic_matrices import exchange_of_p_and_q
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    """Exchange all of q with all of p."""
    only_if(sample.is_turn(one_in=2) and knows_no_coordinates(sample))
    every = exchange_of_p_and_q(sample.hamiltonian.degrees)
    must_be_same_steps(sample, Change(every, Fraction(-1)))
