"""Many points that follow a numerical flow together, in float64.

They do so twice, by extrapolations of two orders (`verify.flows.extrapolation_of_many`). Where the
two are apart by more than `TRUSTED` a point is solved by itself, with more digits; else by how much
they are apart estimates its error. So is a sample solved, that all are held against.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import follow
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import read_prose

Array = Any  # numpy.ndarray, which is imported where it is used
Point = Mapping[str, Fraction]
Solved = Callable[[Point, Fraction, int], tuple[Point, Fraction]]
COLUMNS = 8, 7  # of the two extrapolations
UNIT = 2.0**-53  # the rounding of a result, relative to it
TRUSTED = 1e-8  # the most, of an orbit's scale, that the two may be apart
SAMPLE, DIGITS = 3, 20  # points that are held against a solution with so many digits
METHOD = "numerical flow: Gragg's method, extrapolated, in long double"
_SAFETY = 4  # an error is at most so many times what it is estimated to be by another evaluation


@dataclass(frozen=True)
class Together:
    """φ_t of `starts`, an array (coordinate, point), for each of `times`, from t0 on where H
    depends on time. `solved` (point, time, digits): where one comes to, and a bound of its error.

    `extreme`: whether the sample has the point of the greatest p.
    """

    hamiltonian: Hamiltonian
    starts: Array
    times: Sequence[Fraction]
    t0: Fraction
    solved: Solved
    extreme: bool = False

    def followed(self) -> tuple[Array, float, tuple[int, ...]]:
        """Where they come to, an array (coordinate, time, point); a bound of the error of each
        number, an estimate; and which points were solved by themselves.

        Raises NoFlowError, naming the point, where one cannot be followed so far, and where the
        sample's errors are larger than they are estimated.
        """
        import numpy as np

        h, times = self.hamiltonian, self.times
        fine, rough = (follow(h, self.starts, times, columns, self.t0) for columns in COLUMNS)
        apart = np.abs(fine - rough).max(axis=0)  # (time, point)
        trusted = apart <= TRUSTED * self._scale(fine)  # nan is not
        alone = tuple(map(int, np.flatnonzero(~trusted.all(axis=0))))
        for i in alone:
            for k, time in enumerate(times):
                fine[:, k, i], apart[k, i] = self.exact(i, time)
        estimated = float((apart + UNIT * self._scale(fine)).max(initial=0.0))
        if not times:
            return fine, _SAFETY * estimated, alone
        # Digits of a numerical flow take long: it is held at the longest time.
        k = max(range(len(times)), key=lambda k: abs(times[k]))
        return fine, self._checked(fine[:, k], times[k], alone, _SAFETY * estimated), alone

    def _scale(self, ends: Array) -> Array:
        """The largest coordinate at both ends, in size, for each time and point."""
        import numpy as np

        return np.maximum(np.abs(self.starts).max(axis=0), np.abs(ends).max(axis=0))

    def exact(self, i: int, time: Fraction) -> tuple[list[float], float]:
        """Where point i comes to by itself, and a bound of the error. Raises NoFlowError."""
        names = self.hamiltonian.coordinates
        start = {name: Fraction(x) for name, x in zip(names, self.starts[:, i], strict=True)}
        try:
            point, bound = self.solved(start, time, DIGITS)
            return [float(point[name]) for name in names], float(bound)
        except (NoFlowError, OverflowError) as error:
            raise naming(error, i, start, time) from None

    def _checked(
        self, ends: Array, time: Fraction, alone: Sequence[int], estimated: float
    ) -> float:
        """A bound of the errors, by what the sample's are."""
        worst = 0.0
        for i in self._sample(alone):
            true, bound = self.exact(i, time)
            error = max(abs(float(x) - y) for x, y in zip(ends[:, i], true, strict=True))
            worst = max(worst, error + bound)
            if error > _SAFETY * estimated:
                raise NoFlowError(
                    f"point {i} is wrong by `{error:.2g}` at t = `{float(time):.6g}`, where "
                    f"`{estimated:.2g}` was estimated"
                )
        return max(estimated, _SAFETY * worst)

    def _sample(self, alone: Sequence[int]) -> list[int]:
        """Points found together, evenly between."""
        import numpy as np

        together = np.setdiff1d(np.arange(self.starts.shape[1]), alone)
        if len(together) <= SAMPLE:
            return [int(i) for i in together]
        evenly = np.linspace(0, len(together) - 1, SAMPLE - self.extreme).round().astype(int)
        first = [self.starts[0, together].argmax()] * self.extreme
        return sorted({int(together[i]) for i in (*first, *evenly)})


def naming(
    error: NoFlowError | OverflowError, i: int, start: Mapping[str, Any], time: Fraction
) -> NoFlowError:
    """The error, with the point that it is of; an overflow is one beyond float64."""
    said = error.said if isinstance(error, NoFlowError) else "it is beyond float64"
    names = sorted(start, key=lambda name: name[0] != "q")
    where = ", ".join(f"{name} = `{float(start[name]):.6g}`" for name in names)
    return NoFlowError(read_prose(f"point {i}, {where}, to t = `{float(time):.6g}`: ") + said)
