"""With p and q exchanged, the step for −H(q, p) is that for H(p, q) with p' and q' exchanged.

It is checked for schemes that treat p and q alike.
"""

from fractions import Fraction

from verify.exploration.equivariance import (
    CoordinateChange,
    exchange_of_p_and_q,
    knows_no_coordinates,
    must_be_same_steps,
)
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    """Exchange all of q with all of p."""
    only_if(sample.is_turn(one_in=2) and knows_no_coordinates(sample))
    exchange = exchange_of_p_and_q(sample.hamiltonian.degrees)
    must_be_same_steps(sample, CoordinateChange(exchange, Fraction(-1)))
