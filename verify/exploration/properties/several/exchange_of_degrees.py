"""The run with the degrees of freedom in another order is the same run in that order.

Balls decide, with S and the Jacobian, or two runs if the step is implicit.
"""

from dataclasses import replace

from verify.exploration.equivariance import (
    CoordinateChange,
    cyclic_shift,
    must_be_same_steps,
    transform_point,
    transformed_hamiltonian,
)
from verify.exploration.property import only_if
from verify.exploration.reference_steps import end_of, must_agree
from verify.exploration.sample import Sample


def holds(sample: Sample) -> None:
    change = CoordinateChange(cyclic_shift(sample.hamiltonian.degrees))
    if sample.scheme.explicit:
        only_if(sample.is_turn(one_in=2))
        must_be_same_steps(sample, change)
        return
    only_if(sample.is_turn(one_in=4) and sample.short)
    exchanged = replace(sample, hamiltonian=transformed_hamiltonian(sample, change))
    only_if(exchanged.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    expected = transform_point(change, end_of(sample))
    computed = end_of(exchanged.with_place(transform_point(change, sample.point)))
    must_agree(computed, dict(zip(computed, expected, strict=True)))
