"""The exact flow of many points at once, in float64.

Where a closed form is known it is evaluated in balls, point by point: each error is certified, and
is mostly the rounding to float64. The numerical flow would not do: 2,000 points of the pendulum at
t = 100 take it 10 s, with errors to 5·10⁻¹⁴, and the balls 0.2 s; points of the twist 20 s, with
errors to 10⁻¹¹, and the balls 0.1 s.

Where no closed form is known, the points follow a numerical flow together
(`verify.flows.extrapolation_of_many`) and twice, by extrapolations of two orders. A point at which
the two are apart is left to `exact_solution`, as is a sample, the extreme points among it, that all
are held against.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
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
from verify.flows.sample_check import (
    COLUMNS,
    DIGITS,
    METHOD,
    SAMPLE,
    TRUSTED,
    UNIT,
    checked_bound,
)
from verify.flows.solution import exact_solution
from verify.hamiltonians import known_flows
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


@dataclass(frozen=True)
class Points:
    """φ_t of all points: p and q have a row for each time and a column for each point, float64.

    `bound` ≥ |error| of each of them: certified where a closed form is known, and mostly the
    rounding to float64; else an estimate. `method` says how; `alone` are the points that were left
    out of a numerical flow, and found one by one.
    """

    p: Array
    q: Array
    bound: float
    method: str
    alone: tuple[int, ...] = ()


def exact_points(
    hamiltonian: Hamiltonian, p: Array, q: Array, times: Sequence[Fraction], t0: Fraction = _ZERO
) -> Points:
    """φ_t of the points (p, q), two arrays of float64 of one length, for each time t, from t0 on
    where H depends on time.

    Raises InputError for a parameter without a value and for points that are not such arrays, and
    NoFlowError, naming the point, where one blows up before the last of the times or cannot be
    followed so far, and where a numerical flow fails the check at the sample.
    """
    work = _Work.of(hamiltonian, p, q, times, t0)
    if work.known:
        return work.in_closed_form()
    work.numerically()
    work.one_by_one()
    return work.checked()


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


@dataclass
class _Work:
    """The points, what is found of them, and its errors, by time and point."""

    hamiltonian: Hamiltonian
    p: Array
    q: Array
    times: tuple[Fraction, ...]
    t0: Fraction
    alone: set[int] = field(default_factory=set)
    found: Array = field(init=False)  # (2, times, points), of a numerical flow
    error: Array = field(init=False)  # (times, points)

    @classmethod
    def of(
        cls, hamiltonian: Hamiltonian, p: Array, q: Array, times: Sequence[Fraction], t0: Fraction
    ) -> "_Work":
        import numpy as np

        if hamiltonian.symbols:
            raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
        p, q = (np.asarray(x, dtype=np.float64) for x in (p, q))
        if p.ndim != 1 or p.shape != q.shape:
            raise InputError("points", f"{p.shape}, {q.shape}", "must be two arrays of one length")
        if not (np.isfinite(p).all() and np.isfinite(q).all()):
            raise InputError("points", "nan", "must be finite")
        return cls(hamiltonian, p, q, tuple(times), t0)

    # -- in closed form -----------------------------------------------------------------------

    @property
    def known(self) -> bool:
        """Whether there is a closed form: of one point's motion, and so of all."""
        if not len(self.p):
            return False
        return _motions(self.hamiltonian)(float(self.p[0]), float(self.q[0])) is not None

    def in_closed_form(self) -> Points:
        """Each point by its own motion. Raises NoFlowError."""
        import numpy as np

        follow_one, farthest = _along_flow(self.hamiltonian, self.times), self._farthest
        starts = enumerate(zip(self.p.tolist(), self.q.tolist(), strict=True))
        with working_precision(_BITS):
            told = [self._told(i, farthest, follow_one, *start) for i, start in starts]
        methods = [method for method, _ in told]
        shape = len(told), len(self.times), 3
        states = np.array([states for _, states in told], dtype=np.float64).reshape(shape)
        p, q, error = np.ascontiguousarray(states.T)
        bound = float(error.max(initial=0.0))
        method = f"{max(dict.fromkeys(methods), key=methods.count)}, in balls"
        return Points(p, q, bound, method)

    @property
    def _farthest(self) -> Fraction:
        return max(self.times, key=abs, default=_ZERO)

    def _told(self, i: int, time: Fraction, how: Callable[..., Any], *arguments: Any) -> Any:
        """What `how` finds; NoFlowError, naming the point, where it finds nothing."""
        try:
            return how(*arguments)
        except (NoFlowError, OverflowError) as error:
            said = error.said if isinstance(error, NoFlowError) else "it is beyond float64"
            where = f"point {i}, q = `{self.q[i]:.6g}`, p = `{self.p[i]:.6g}`"
            at = read_prose(f"{where}, to t = `{float(time):.6g}`: ")
            raise NoFlowError(at + said) from None

    def _start(self, i: int) -> tuple[Fraction, Fraction]:
        return Fraction(self.p[i]), Fraction(self.q[i])

    # -- without ------------------------------------------------------------------------------

    def numerically(self) -> None:
        """All points twice, by extrapolations of two orders."""
        import numpy as np

        given = self.hamiltonian, (self.p, self.q), self.times
        fine, rough = (follow(*given, columns, self.t0) for columns in COLUMNS)
        self.found, self.error = fine.astype(np.float64), np.zeros((len(self.times), len(self.p)))
        every = np.arange(len(self.p))
        for k in range(len(self.times)):
            apart = np.max(abs(fine[:, k] - rough[:, k]), axis=0)
            scale = self._scale(k, every)
            self.alone.update(int(i) for i in every[~(apart <= TRUSTED * scale)])  # nan is not
            self.error[k] = apart + UNIT * scale

    def _scale(self, k: int, group: Array) -> Array:
        """The largest of |p| and |q| at both ends, for each of the points."""
        import numpy as np

        ends = (self.p[group], self.q[group], *self.found[:, k, group])
        return np.max(np.abs(ends), axis=0)

    def one_by_one(self) -> None:
        """Those that were kept for later. Raises NoFlowError."""
        for i in sorted(self.alone):
            for k in range(len(self.times)):
                self.found[:, k, i], bound = self._exact(i, k)
                self.error[k, i] = bound + UNIT * self._scale(k, [i])[0]

    def _exact(self, i: int, k: int) -> tuple[tuple[float, float], float]:
        def solved(p: Fraction, q: Fraction, time: Fraction) -> tuple[tuple[float, float], float]:
            found = exact_solution(self.hamiltonian, p=p, q=q, time=time, digits=DIGITS, t0=self.t0)
            return (float(found.p), float(found.q)), float(found.bound)

        found: tuple[tuple[float, float], float] = self._told(
            i, self.times[k], solved, *self._start(i), self.times[k]
        )
        return found

    def checked(self) -> Points:
        """What was found, where the sample's errors are no larger than they are estimated."""
        # Digits of a numerical flow take long: it is held at the longest time.
        k = max(range(len(self.times)), key=lambda k: abs(self.times[k]), default=None)
        bound = checked_bound(
            lambda i: self.found[:, k, i],
            lambda i: self._exact(i, k or 0),
            () if k is None else self._sample(),
            float(self.error.max(initial=0.0)),
            _ZERO if k is None else self.times[k],
        )
        p, q = self.found
        alone = tuple(sorted(self.alone))
        return Points(p, q, bound, METHOD if len(p.T) else "no points", alone)

    def _sample(self) -> list[int]:
        """Points found together: one of extreme p, and others evenly between."""
        import numpy as np

        together = np.setdiff1d(np.arange(len(self.p)), sorted(self.alone))
        if len(together) <= SAMPLE:
            return [int(i) for i in together]
        evenly = np.linspace(0, len(together) - 1, SAMPLE - 1).round().astype(int)
        return sorted({int(together[i]) for i in (self.p[together].argmax(), *evenly)})
