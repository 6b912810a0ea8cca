"""The run with the degrees of freedom in another order is the same run in that order.

Balls decide, with S and the Jacobian, or two runs if the step is implicit.
"""

from dataclasses import replace

from verify.exploration import equivariance
from verify.exploration.property import only_if
from verify.exploration.reference_steps import end_of, must_agree
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    change = equivariance.CoordinateChange(equivariance.cyclic_shift(sample.hamiltonian.degrees))
    if sample.scheme.explicit:
        only_if(sample.is_turn(one_in=2))
        equivariance.must_be_same_steps(sample, change)
        return
    only_if(sample.is_turn(one_in=4) and sample.short)
    exchanged = replace(sample, hamiltonian=equivariance.transformed_hamiltonian(sample, change))
    only_if(exchanged.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    expected = equivariance.transform_point(change, end_of(sample))
    computed = end_of(exchanged.with_place(equivariance.transform_point(change, sample.point)))
    must_agree(computed, dict(zip(computed, expected, strict=True)))
