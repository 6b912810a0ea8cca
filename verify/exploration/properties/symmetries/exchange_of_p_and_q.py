"""With p and q exchanged, the step for −H(q, p) is that for H(p, q) with p' and q' exchanged.

It is checked for schemes that treat p and q alike.
"""

from fractions import Fraction

from verify.exploration import equivariance
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    """Exchange all of q with all of p."""
    only_if(sample.is_turn(one_in=2) and equivariance.knows_no_coordinates(sample))
    exchange = equivariance.exchange_of_p_and_q(sample.hamiltonian.degrees)
    equivariance.must_be_same_steps(sample, equivariance.CoordinateChange(exchange, Fraction(-1)))
