"""The exact flow of many points at once, in float64.

Where a closed form is known it is evaluated in balls, point by point: each error is certified, and
is mostly the rounding to float64. The numerical flow is slower and less accurate: 2,000 points of
the pendulum at t = 100 take it 10 s, with errors to 5·10⁻¹⁴, and the balls 0.2 s; those of the
twist take it 20 s, with errors to 10⁻¹¹, and the balls 0.1 s.

Where no closed form is known, the points follow a numerical flow together. They do so twice, by
extrapolations of two orders (`verify.flows.extrapolation_of_many`). Where the two differ by more
than `TRUSTED` a point is solved by itself, with more digits; elsewhere four times their difference
estimates the error. A sample of the points is solved one by one too, and must confirm the estimate.
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
from verify.flows import ball_evaluation
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import follow
from verify.flows.solution import solution_from
from verify.hamiltonians import flow_recognition
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import Motion, exactly
from verify.prose import read_prose

Array = Any  # numpy.ndarray, which is imported where it is used
_ZERO = Fraction(0)
_ROUND_UP_FACTOR = 1 + 2.0**-50  # covers the rounding of a bound itself
_CACHED_POINTS = 1 << 16  # limit for each cached flow; a point in closed form takes 0.2 ms
_CACHED_MOTIONS = 1 << 15  # limit for each H; a motion takes some 4 kB
_CACHED_FLOWS = 3  # a flow with its cached points takes some 30 MB
_RoundedState = tuple[float, float, float]
_Evaluation = tuple[str, tuple[_RoundedState, ...]]
_BITS = ball_evaluation.first_precision(16)
_BALL_TOLERANCE = 1e-18  # a ball's largest radius, in orbit scales: far below float64's rounding
COLUMNS = 8, 7  # the numbers of columns of the two extrapolations
UNIT = 2.0**-53  # the relative rounding of a result to float64
TRUSTED = 1e-8  # the largest difference of the two extrapolations, in orbit scales
SAMPLE, DIGITS = 3, 20  # the points of the sample, and the digits of their solutions
METHOD = "numerical flow: Gragg's method, extrapolated, in long double"
_SAFETY = 4  # ratio of an estimated bound to the difference from another evaluation


@dataclass(frozen=True)
class Points:
    """The states φ_t of all points.

    `points` has an array of float64 for each coordinate, by its name, with a row for each time and
    a column for each point.

    `bound` ≥ |error| of each of them: certified where a closed form is known, and mostly the
    rounding to float64; else an estimate. `method` says how; `outliers` are the points that were
    left out of a numerical flow, and solved one by one.
    """

    points: Mapping[str, Array]
    bound: float
    method: str
    outliers: tuple[int, ...] = ()


def exact_points(
    hamiltonian: Hamiltonian,
    points: Mapping[str, Array],
    times: Sequence[Fraction],
    t0: Fraction = _ZERO,
) -> Points:
    """Return φ_t of the points for each time t, which is counted from t0 where H depends on time.

    `points`: an array of float64 for each coordinate, by its name, all of one length.

    Raises InputError for a parameter without a value and for points that are not such arrays, and
    NoFlowError, naming the point, if one blows up before the last of the times or cannot be
    followed so far, and if a numerical flow fails the check at the sample.
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
    # The first point decides: a closed form is known for every start of an H, or for none.
    plane = hamiltonian.planar  # closed forms are used only in the plane
    if plane and len(z[0]) and _motions(hamiltonian)(*(float(x[0]) for x in z)) is not None:
        return _in_closed_form(hamiltonian, z, tuple(times))
    together = _CommonFlow(hamiltonian, np.array(z), tuple(times), t0, extreme=plane)
    ends, bound, outliers = together.follow_all()
    method = METHOD if len(ends[0]) else "no points"
    return Points(dict(zip(names, ends, strict=True)), bound, method, outliers)


def _in_closed_form(
    hamiltonian: Hamiltonian, z: Sequence[Array], times: tuple[Fraction, ...]
) -> Points:
    """Solve each point by its own motion. Raises NoFlowError."""
    import numpy as np

    follow_one = _closed_form_evaluator(hamiltonian, times)
    farthest = max(times, key=abs, default=_ZERO)
    rows = []
    with working_precision(_BITS):
        for i, start in enumerate(zip(*(x.tolist() for x in z), strict=True)):
            try:
                rows.append(follow_one(*start))
            except (NoFlowError, OverflowError) as error:
                raise name_point(error, i, dict(zip(PLANE, start, strict=True)), farthest) from None
    methods = [method for method, _ in rows]
    # A row is (p, q, bound) at each time; transposed, the three are arrays (time, point).
    shape = len(rows), len(times), 3
    states = np.array([states for _, states in rows], dtype=np.float64).reshape(shape)
    *ends, errors = np.ascontiguousarray(states.T)
    bound = float(errors.max(initial=0.0))
    method = f"{max(dict.fromkeys(methods), key=methods.count)}, in balls"
    return Points(dict(zip(PLANE, ends, strict=True)), bound, method)


@lru_cache(maxsize=_CACHED_FLOWS)
def _closed_form_evaluator(
    hamiltonian: Hamiltonian, times: tuple[Fraction, ...]
) -> Callable[..., _Evaluation]:
    """Return (p, q) ↦ the method, and for each time p, q and a bound of the error of each.

    Several maps are compared with the exact flow at the same points: the function caches them. It
    must be called with flint's precision at `_BITS`. It raises NoFlowError, and OverflowError
    beyond float64.
    """
    zero = Fraction(0)
    ends = {max((zero, *times)), min((zero, *times))} - {zero}
    exact_times = [exactly(time) for time in times]
    motion_from = _motions(hamiltonian)

    @lru_cache(maxsize=_CACHED_POINTS)
    def evaluate_point(p: float, q: float) -> _Evaluation:
        motion = motion_from(p, q)
        assert motion is not None  # noqa: S101 - as another point has one
        for time in ends:
            ball_evaluation.check_no_blow_up(motion, time)
        return motion.method, tuple(
            [_round_state(motion, p, q, exact_time) for exact_time in exact_times]
        )

    return evaluate_point


@lru_cache(maxsize=_CACHED_FLOWS)
def _motions(hamiltonian: Hamiltonian) -> Callable[[float, float], Motion | None]:
    """Return a function from (p, q) to the motion that starts there, cached for all times."""
    motion_from = flow_recognition.motions(hamiltonian)
    return lru_cache(maxsize=_CACHED_MOTIONS)(lambda p, q: motion_from(Fraction(p), Fraction(q)))


def _round_state(motion: Motion, p: float, q: float, time: fmpq) -> _RoundedState:
    """Return p, q in float64 and a bound of the error of each."""
    if time == 0 or motion.is_at_rest:
        return p, q, 0.0
    evaluate = partial(_round_to_float64, motion, max(abs(p), abs(q)), time)
    # Most states are rounded at the precision that is set; a wide ball takes more bits.
    return evaluate() or ball_evaluation.try_precisions_from(evaluate, 2 * _BITS)


def _round_to_float64(motion: Motion, least: float, time: fmpq) -> _RoundedState | None:
    """Return p, q and a bound as `_round_state` does; None if flint's precision is not enough.

    `least`: a lower bound of the orbit's scale. Raises OverflowError beyond float64.
    """
    exact_p, exact_q = motion.state(arb(time))
    if not (exact_p.is_finite() and exact_q.is_finite()):
        return None
    p, q = float(exact_p.mid()), float(exact_q.mid())
    fine = _BALL_TOLERANCE * max(least, abs(p), abs(q))
    if not (float(exact_p.rad()) < fine and float(exact_q.rad()) < fine):
        return None
    if not (isfinite(p) and isfinite(q)):
        raise OverflowError
    # The bound is the distance from the float64 to the far end of the ball, so that it includes
    # both the ball and the rounding.
    error = max(float((exact_p - p).abs_upper()), float((exact_q - q).abs_upper()))
    return p, q, error * _ROUND_UP_FACTOR


@dataclass(frozen=True)
class _CommonFlow:
    """A numerical flow of all points together.

    `starts` is an array (coordinate, point); `times` are counted from t0 where H depends on time.
    `extreme`: True if the sample includes the point with the greatest p.
    """

    hamiltonian: Hamiltonian
    starts: Array
    times: Sequence[Fraction]
    t0: Fraction
    extreme: bool

    def follow_all(self) -> tuple[Array, float, tuple[int, ...]]:
        """Return the states, a bound of their errors, and the points that were solved alone.

        The states are an array (coordinate, time, point); the bound, an estimate, is one number for
        all of them.

        Raises NoFlowError, naming the point, if one cannot be followed so far, and if an error in
        the sample is more than 4 times the estimated bound.
        """
        import numpy as np

        h, times = self.hamiltonian, self.times
        fine, rough = (follow(h, self.starts, times, columns, self.t0) for columns in COLUMNS)
        differences = np.abs(fine - rough).max(axis=0)  # (time, point)
        # The difference is nan for a point that could not be followed; nan compares as False.
        is_trusted = differences <= TRUSTED * self._scale(fine)
        outliers = tuple(map(int, np.flatnonzero(~is_trusted.all(axis=0))))
        for i in outliers:
            for k, time in enumerate(times):
                fine[:, k, i], differences[k, i] = self.solve_exactly(i, time)
        estimate = float((differences + UNIT * self._scale(fine)).max(initial=0.0))
        if not times:
            return fine, _SAFETY * estimate, outliers
        # Digits of a numerical flow take long: the sample is solved for the longest time only.
        k = max(range(len(times)), key=lambda k: abs(times[k]))
        return (
            fine,
            self._check_sample(fine[:, k], times[k], outliers, _SAFETY * estimate),
            outliers,
        )

    def _scale(self, ends: Array) -> Array:
        """Return the largest |coordinate| at both ends, for each time and point."""
        import numpy as np

        return np.maximum(np.abs(self.starts).max(axis=0), np.abs(ends).max(axis=0))

    def solve_exactly(self, i: int, time: Fraction) -> tuple[list[float], float]:
        """Solve point i by itself; return its state and a bound of the error before rounding.

        Raises NoFlowError.
        """
        names = self.hamiltonian.coordinates
        start = {name: Fraction(x) for name, x in zip(names, self.starts[:, i], strict=True)}
        try:
            solution = solution_from(self.hamiltonian, start, time, DIGITS, self.t0)
            return [float(solution.point[name]) for name in names], float(solution.bound)
        except (NoFlowError, OverflowError) as error:
            raise name_point(error, i, start, time) from None

    def _check_sample(
        self, ends: Array, time: Fraction, outliers: Sequence[int], estimate: float
    ) -> float:
        """Return a bound of the errors, raised if the sample asks for it.

        Raises NoFlowError if an error in the sample is more than 4 times `estimate`.
        """
        worst = 0.0
        # Points that were solved alone have a bound already; the others need a check.
        for i in self._sample(outliers):
            true, bound = self.solve_exactly(i, time)
            error = max(abs(float(x) - y) for x, y in zip(ends[:, i], true, strict=True))
            worst = max(worst, error + bound)
            if error > _SAFETY * estimate:
                raise NoFlowError(
                    f"point {i} is wrong by `{error:.2g}` at t = `{float(time):.6g}`, where "
                    f"`{estimate:.2g}` was estimated"
                )
        return max(estimate, _SAFETY * worst)

    def _sample(self, outliers: Sequence[int]) -> list[int]:
        """Select evenly spaced points of those followed together; `extreme` adds the greatest p."""
        import numpy as np

        together = np.setdiff1d(np.arange(self.starts.shape[1]), outliers)
        if len(together) <= SAMPLE:
            return [int(i) for i in together]
        evenly = np.linspace(0, len(together) - 1, SAMPLE - self.extreme).round().astype(int)
        first = [self.starts[0, together].argmax()] * self.extreme
        return sorted({int(together[i]) for i in (*first, *evenly)})


def name_point(
    error: NoFlowError | OverflowError, i: int, start: Mapping[str, Any], time: Fraction
) -> NoFlowError:
    """Return the error as a NoFlowError that names its point; an overflow is beyond float64."""
    reason = error.reason if isinstance(error, NoFlowError) else "it is beyond float64"
    names = sorted(start, key=lambda name: name[0] != "q")
    coordinates = ", ".join(f"{name} = `{float(start[name]):.6g}`" for name in names)
    return NoFlowError(
        read_prose(f"point {i}, {coordinates}, to t = `{float(time):.6g}`: ") + reason
    )
