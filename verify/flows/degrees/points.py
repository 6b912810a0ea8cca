"""The exact flow of many points at once in n degrees of freedom, in float64.

As in the plane (`verify.flows.points`) the points follow a numerical flow together and twice, by
extrapolations of two orders. A point at which the two are apart is left to `solution_in_degrees`,
as is a sample that all are held against.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.flows.degrees.solution import solution_in_degrees
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import follow
from verify.flows.sample_check import (
    COLUMNS,
    DIGITS,
    METHOD,
    SAMPLE,
    TRUSTED,
    UNIT,
    checked_bound,
)
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import read_prose

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

    Raises NoFlowError, naming the point, where one cannot be followed so far, and where the
    numerical flow fails the check at the sample.
    """
    import numpy as np

    names = hamiltonian.coordinates
    given = np.array([points[name] for name in names], dtype=np.float64)
    fine, rough = (follow(hamiltonian, given, [time], k, t0)[:, 0] for k in COLUMNS)
    apart = abs(fine - rough).max(axis=0)
    scale = np.maximum(abs(given).max(axis=0), abs(fine).max(axis=0))
    alone = np.flatnonzero(~(apart <= TRUSTED * scale))  # nan is not
    own = _Exact(hamiltonian, names, given, time, t0)
    for i in map(int, alone):
        fine[:, i], apart[i] = own(i)
    together = np.setdiff1d(np.arange(given.shape[1]), alone)
    places = np.linspace(0, len(together) - 1, min(SAMPLE, len(together))).round().astype(int)
    sample = sorted({int(together[k]) for k in places})
    greatest = float((apart + UNIT * scale).max(initial=0.0))
    bound = checked_bound(lambda i: fine[:, i], own, sample, greatest, time)
    return PointsInDegrees(dict(zip(names, fine, strict=True)), bound)


@dataclass(frozen=True)
class _Exact:
    """Points by themselves, with more digits."""

    hamiltonian: Hamiltonian
    names: tuple[str, ...]
    given: Array
    time: Fraction
    t0: Fraction

    def __call__(self, i: int) -> tuple[list[float], float]:
        """Where point i comes to, and the error of each coordinate. Raises NoFlowError."""
        start = {name: Fraction(x) for name, x in zip(self.names, self.given[:, i], strict=True)}
        try:
            found = solution_in_degrees(self.hamiltonian, start, self.time, DIGITS, self.t0)
        except NoFlowError as error:
            where = ", ".join(f"{name} = `{float(x):.6g}`" for name, x in start.items())
            at = read_prose(f"point {i}, {where}, to t = `{float(self.time):.6g}`: ")
            raise NoFlowError(at + error.said) from None
        return [float(found.point[name]) for name in self.names], float(found.bound)
