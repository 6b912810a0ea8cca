"""The exact flow of many points at once in n degrees of freedom, in float64.

As in the plane without a closed form (`verify.flows.points`) they follow a numerical flow together.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.flows.degrees.solution import solution_in_degrees
from verify.flows.points_together import METHOD, Point, Together
from verify.hamiltonians.hamiltonian import Hamiltonian

Array = Any  # numpy.ndarray, which is imported where it is used
_ZERO = Fraction(0)


@dataclass(frozen=True)
class PointsInDegrees:
    """φ_t of all points by their coordinates, arrays of float64; `bound` ≥ |error| of each, an
    estimate, by the `method`."""

    points: Mapping[str, Array]
    bound: float
    method: str = METHOD


def points_in_degrees(
    hamiltonian: Hamiltonian, points: Mapping[str, Array], time: Fraction, t0: Fraction = _ZERO
) -> PointsInDegrees:
    """φ_time of the points, arrays of float64 of one length by the names p1 … qn, from t0 on where
    H depends on time. H has no parameter without a value.

    Raises NoFlowError as `Together.followed` does.
    """
    import numpy as np

    def solved(start: Point, time: Fraction, digits: int) -> tuple[Point, Fraction]:
        solution = solution_in_degrees(hamiltonian, start, time, digits, t0)
        return solution.point, solution.bound

    names = hamiltonian.coordinates
    starts = np.array([points[name] for name in names], dtype=np.float64)
    ends, bound, _ = Together(hamiltonian, starts, [time], t0, solved).followed()
    return PointsInDegrees(dict(zip(names, ends[:, 0], strict=True)), bound)
