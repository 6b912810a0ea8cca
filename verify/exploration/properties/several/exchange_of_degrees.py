"""With the degrees of freedom put in another order, the run is the same run in that order.

By balls, with S and the Jacobian; of a step that solves equations by two runs.
"""

from dataclasses import replace

from verify.exploration.oracles.equivariance import (
    Change,
    moved,
    must_be_same_steps,
    transformed_hamiltonian,
)
from verify.exploration.oracles.mpfr_runs import end_of, must_agree
from verify.exploration.oracles.symplectic_matrices import cycled
from verify.exploration.property import only_if
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    change = Change(cycled(sample.hamiltonian.degrees))
    if sample.scheme.explicit:
        only_if(sample.is_turn(one_in=2))
        must_be_same_steps(sample, change)
        return
    only_if(sample.is_turn(one_in=4) and sample.short)
    other = replace(sample, hamiltonian=transformed_hamiltonian(sample, change))
    only_if(other.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    wanted = moved(change, end_of(sample))
    found = end_of(other.at(moved(change, sample.point)))
    must_agree(found, dict(zip(found, wanted, strict=True)))
