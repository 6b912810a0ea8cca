"""With the degrees of freedom put in another order, the run is the same run in that order.

By balls, with S and the Jacobian; of a step that solves equations by two runs of 30 digits.
"""

from fractions import Fraction

from verify.exploration.oracles.equivariance import (
    Change,
    moved,
    must_be_same_steps,
    transformed_hamiltonian,
)
from verify.exploration.oracles.mpfr_runs import RunInDegrees, must_agree
from verify.exploration.oracles.symplectic_matrices import cycled
from verify.exploration.property import only_if
from verify.exploration.sample_in_degrees import SampleInDegrees

_IN, _OF_EQUATIONS = 2, 4  # one in so many samples


def holds_in_degrees(sample: SampleInDegrees) -> None:
    change = Change(cycled(sample.hamiltonian.degrees))
    if sample.scheme.explicit:
        only_if(sample.is_turn(_IN))
        must_be_same_steps(sample, change)
        return
    only_if(sample.is_turn(_OF_EQUATIONS) and sample.short)
    other = transformed_hamiltonian(sample, change)
    only_if(other.coordinates == sample.hamiltonian.coordinates)
    start = dict(zip(sample.point, moved(change, sample.point), strict=True))
    wanted = moved(change, RunInDegrees.of(sample).end)
    found = RunInDegrees(other, start, sample).end
    must_agree(found, dict(zip(found, wanted, strict=True)), Fraction(1))
