"""At which points H has a motion: no step is to blame that fails elsewhere."""

from collections.abc import Sequence
from fractions import Fraction

from verify.flows.degrees.extrapolation import FlowInDegrees
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

_DIGITS = 15
UNDEFINED = "; H has no exact solution from any of the points that are tried"


def first_defined(
    hamiltonian: Hamiltonian, points: Sequence[tuple[Fraction, ...]], h: Fraction, t: Fraction
) -> tuple[Fraction, ...] | None:
    """The first of the points from which the exact flow reaches h; None where there is none."""
    flow = FlowInDegrees(canonical_field(hamiltonian)[0], _DIGITS)
    for point in points:
        start = dict(zip(hamiltonian.coordinates, point, strict=True))
        try:
            flow.advance(flow.state({**start, "t": t}), flow.number(h))
        except NoFlowError:
            continue
        return point
    return None
