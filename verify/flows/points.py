"""The exact flow of many points at once, in float64.

Where a closed form is known it is evaluated in balls, point by point: each error is certified, and
is mostly the rounding to float64. The numerical flow would not do: 2,000 points of the pendulum at
t = 100 take it 10 s, with errors to 5·10⁻¹⁴, and the balls 0.2 s; points of the twist 20 s, with
errors to 10⁻¹¹, and the balls 0.1 s.

Where no closed form is known, the points follow a numerical flow together. They do so twice, by
extrapolations of two orders (`verify.flows.extrapolation_of_many`). Where the two are apart by more
than `TRUSTED` a point is solved by itself, with more digits; else by how much they are apart
estimates its error. So is a sample solved, that all are held against.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from math import isfinite
from typing import Any

from flint import arb, fmpq

from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows import closed_form
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import follow
from verify.flows.solution import solution_from
from verify.hamiltonians import known_flows
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.motion import Motion, exactly
from verify.prose import read_prose

Array = Any  # numpy.ndarray, which is imported where it is used
_ZERO = Fraction(0)
_UPWARDS = 1 + 2.0**-50  # for a bound that is itself rounded
_REMEMBERED = 1 << 16  # points in closed form, of which one takes a fifth of a millisecond
_MOTIONS = 1 << 15  # some 4 kB each
_FLOWS = 3  # for which so many points are, in some 30 MB each
_Rounded = tuple[float, float, float]
_Told = tuple[str, tuple[_Rounded, ...]]
_BITS = closed_form.first_precision(16)
_FINE = 1e-18  # of an orbit's scale: a ball's radius, far below float64's rounding
COLUMNS = 8, 7  # of the two extrapolations
UNIT = 2.0**-53  # the rounding of a result, relative to it
TRUSTED = 1e-8  # the most, of an orbit's scale, that the two may be apart
SAMPLE, DIGITS = 3, 20  # points that are held against a solution with so many digits
METHOD = "numerical flow: Gragg's method, extrapolated, in long double"
_SAFETY = 4  # an error is at most so many times what it is estimated to be by another evaluation


@dataclass(frozen=True)
class Points:
    """φ_t of all points: `points` has an array for each coordinate, by its name, with a row for
    each time and a column for each point, float64.

    `bound` ≥ |error| of each of them: certified where a closed form is known, and mostly the
    rounding to float64; else an estimate. `method` says how; `alone` are the points that were left
    out of a numerical flow, and found one by one.
    """

    points: Mapping[str, Array]
    bound: float
    method: str
    alone: tuple[int, ...] = ()


def exact_points(
    hamiltonian: Hamiltonian,
    points: Mapping[str, Array],
    times: Sequence[Fraction],
    t0: Fraction = _ZERO,
) -> Points:
    """φ_t of the points, an array of float64 for each coordinate, by its name, all of one length,
    for each time t, from t0 on where H depends on time.

    Raises InputError for a parameter without a value and for points that are not such arrays, and
    NoFlowError, naming the point, where one blows up before the last of the times or cannot be
    followed so far, and where a numerical flow fails the check at the sample.
    """
    import numpy as np

    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
    names = hamiltonian.coordinates
    z = [np.asarray(points[name], dtype=np.float64) for name in names]
    if z[0].ndim != 1 or len({x.shape for x in z}) > 1:
        shapes = ", ".join(str(x.shape) for x in z)
        raise InputError("points", shapes, "must be arrays of one length")
    if not np.isfinite(z).all():
        raise InputError("points", "nan", "must be finite")
    plane = hamiltonian.planar  # of which alone closed forms are looked at
    if plane and len(z[0]) and _motions(hamiltonian)(*(float(x[0]) for x in z)) is not None:
        return _in_closed_form(hamiltonian, z, tuple(times))
    together = _Together(hamiltonian, np.array(z), tuple(times), t0, extreme=plane)
    ends, bound, alone = together.followed()
    method = METHOD if len(ends[0]) else "no points"
    return Points(dict(zip(names, ends, strict=True)), bound, method, alone)


def _in_closed_form(
    hamiltonian: Hamiltonian, z: Sequence[Array], times: tuple[Fraction, ...]
) -> Points:
    """Each point by its own motion. Raises NoFlowError."""
    import numpy as np

    follow_one, farthest = _along_flow(hamiltonian, times), max(times, key=abs, default=_ZERO)
    told = []
    with working_precision(_BITS):
        for i, start in enumerate(zip(*(x.tolist() for x in z), strict=True)):
            try:
                told.append(follow_one(*start))
            except (NoFlowError, OverflowError) as error:
                raise naming(error, i, dict(zip(PLANE, start, strict=True)), farthest) from None
    methods = [method for method, _ in told]
    shape = len(told), len(times), 3
    states = np.array([states for _, states in told], dtype=np.float64).reshape(shape)
    *ends, errors = np.ascontiguousarray(states.T)
    bound = float(errors.max(initial=0.0))
    method = f"{max(dict.fromkeys(methods), key=methods.count)}, in balls"
    return Points(dict(zip(PLANE, ends, strict=True)), bound, method)


@lru_cache(maxsize=_FLOWS)
def _along_flow(hamiltonian: Hamiltonian, times: tuple[Fraction, ...]) -> Callable[..., _Told]:
    """(p, q) ↦ by what motion a point goes, and at each time p, q and a bound of the error of each.

    Several maps carry the same points of a region, and are held against the same exact ones. It
    is called with flint's precision at `_BITS`, and raises NoFlowError, and OverflowError beyond
    float64.
    """
    zero = Fraction(0)
    ends = {max((zero, *times)), min((zero, *times))} - {zero}
    exact_times = [exactly(time) for time in times]
    motion_from = _motions(hamiltonian)

    @lru_cache(maxsize=_REMEMBERED)
    def told(p: float, q: float) -> _Told:
        motion = motion_from(p, q)
        assert motion is not None  # noqa: S101 - as another point has one
        for time in ends:
            closed_form.ends_after(motion, time)
        return motion.method, tuple([_rounded(motion, p, q, at) for at in exact_times])

    return told


@lru_cache(maxsize=_FLOWS)
def _motions(hamiltonian: Hamiltonian) -> Callable[[float, float], Motion | None]:
    """(p, q) ↦ the motion from there: what is exact of it serves for all times."""
    motion_from = known_flows.motions(hamiltonian)
    return lru_cache(maxsize=_MOTIONS)(lambda p, q: motion_from(Fraction(p), Fraction(q)))


def _rounded(motion: Motion, p: float, q: float, at: fmpq) -> _Rounded:
    """p, q and a bound of the error of each as they stand in float64."""
    if at == 0 or motion.rest:
        return p, q, 0.0
    found = partial(_in_float64, motion, max(abs(p), abs(q)), at)
    return found() or closed_form.from_precision(found, 2 * _BITS)


def _in_float64(motion: Motion, least: float, at: fmpq) -> _Rounded | None:
    """The same; None where flint's precision does not tell. `least`: of the size of an orbit."""
    exact_p, exact_q = motion.state(arb(at))
    if not (exact_p.is_finite() and exact_q.is_finite()):
        return None
    p, q = float(exact_p.mid()), float(exact_q.mid())
    fine = _FINE * max(least, abs(p), abs(q))
    if not (float(exact_p.rad()) < fine and float(exact_q.rad()) < fine):
        return None
    if not (isfinite(p) and isfinite(q)):
        raise OverflowError
    error = max(float((exact_p - p).abs_upper()), float((exact_q - q).abs_upper()))
    return p, q, error * _UPWARDS


@dataclass(frozen=True)
class _Together:
    """φ_t of `starts`, an array (coordinate, point), for each of `times`, from t0 on where H
    depends on time. `extreme`: whether the sample has the point of the greatest p.
    """

    hamiltonian: Hamiltonian
    starts: Array
    times: Sequence[Fraction]
    t0: Fraction
    extreme: bool

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
            found = solution_from(self.hamiltonian, start, time, DIGITS, self.t0)
            return [float(found.point[name]) for name in names], float(found.bound)
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
