"""The exact flow of many points at once, in float64.

Where a closed form is known it is evaluated for all points together, in the C compiler's long
double and again in float64: how far the two are apart tells point by point how many digits the
formula loses there. A point that loses too many (near a separatrix) is left to `exact_solution`,
one by one, as all are on a machine whose long double is float64. Where no closed form is known, the
points follow a numerical flow together (`verify.flows.extrapolation_of_many`). Either is held
against `exact_solution` at a sample of the points, the extreme ones among them.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from verify.arithmetic.batch import Batch, exact, in_groups
from verify.arithmetic.float_context import FLOAT, WIDE
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import follow
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.known_flows import closed_form
from verify.hamiltonians.motion import Motion, number
from verify.prose import read_prose

Array = Any  # numpy.ndarray, which is imported where it is used
_UNIT = 2.0**-53  # the rounding of a result, relative to it
_SAFETY = 4  # an error is at most so many times what it is estimated to be by another evaluation
_TRUSTED = 2.0**-31  # the most, of an orbit's scale, that float64 may be wrong for a point ...
_TRUSTED_NUMERICAL = 1e-8  # ... and two numerical flows apart
_SAMPLE, _SAMPLE_NUMERICAL = 12, 3  # points held against `exact_solution`
_DIGITS = 20
_BEFORE = 1 - 1e-9  # of the time of a blow-up, up to which floats can tell


@dataclass(frozen=True)
class Points:
    """φ_t of all points: p and q have a row for each time and a column for each point, float64.

    `bound` ≥ |error| of each of them, by estimate: some 10⁻¹² of an orbit's scale at most in closed
    form, and mostly the rounding to float64; `method` says how; `alone` are the points that
    float64 cannot tell, which were found one by one.
    """

    p: Array
    q: Array
    bound: float
    method: str
    alone: tuple[int, ...] = ()


def exact_points(hamiltonian: Hamiltonian, p: Array, q: Array, times: Sequence[Fraction]) -> Points:
    """φ_t of the points (p, q), two arrays of float64 of one length, for each time t.

    Raises InputError for a parameter without a value and for points that are not such arrays, and
    NoFlowError, naming the point, where one blows up before the last of the times or cannot be
    followed so far, and where the check at the sample fails.
    """
    work = _Work.of(hamiltonian, p, q, times)
    known = bool(len(work.p)) and _has_closed_form(hamiltonian, work)
    if known:
        work.in_closed_form()
    else:
        work.numerically()
    work.one_by_one()
    return work.checked(_SAMPLE if known else _SAMPLE_NUMERICAL)


def _has_closed_form(hamiltonian: Hamiltonian, work: "_Work") -> bool:
    return closed_form(hamiltonian, Fraction(work.p[0]), Fraction(work.q[0])) is not None


@dataclass
class _Work:
    """The points, what is found of them, and its estimated errors, by time and point."""

    hamiltonian: Hamiltonian
    p: Array
    q: Array
    times: tuple[Fraction, ...]
    found: Array  # (2, times, points)
    error: Array  # (times, points)
    alone: set[int] = field(default_factory=set)
    method: str = "no points"
    _largest: int = 0  # the group whose method is told

    @classmethod
    def of(cls, hamiltonian: Hamiltonian, p: Array, q: Array, times: Sequence[Fraction]) -> "_Work":
        import numpy as np

        if hamiltonian.symbols:
            raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
        p, q = (np.asarray(x, dtype=np.float64) for x in (p, q))
        if p.ndim != 1 or p.shape != q.shape:
            raise InputError("points", f"{p.shape}, {q.shape}", "must be two arrays of one length")
        if not (np.isfinite(p).all() and np.isfinite(q).all()):
            raise InputError("points", "nan", "must be finite")
        shape = len(times), len(p)
        return cls(hamiltonian, p, q, tuple(times), np.zeros((2, *shape)), np.zeros(shape))

    # -- in closed form -----------------------------------------------------------------------

    def in_closed_form(self) -> None:
        """All points in groups; those that floats cannot tell are kept for later."""
        import numpy as np

        if WIDE.prec < FLOAT.prec + 10:
            self.alone.update(range(len(self.p)))
            self.method = "closed form, point by point"
            return
        p, q = exact(self.p).values, exact(self.q).values

        def evaluate(group: Array) -> None:
            start: list[Any] = [Batch(p[group]), Batch(q[group])]
            known = closed_form(self.hamiltonian, *start)
            if known is None:
                raise ValueError("it has no closed form")
            self._move(group, known[0])

        with np.errstate(all="ignore"):  # what is not finite is followed alone
            in_groups(len(self.p), evaluate, self._leave)

    def _leave(self, points: Iterable[Any]) -> None:
        self.alone.update(int(k) for k in points)

    def _move(self, group: Array, motion: Motion) -> None:
        import numpy as np

        late = self._late(group, motion)
        for k, time in enumerate(self.times):
            fine, rough = (
                [np.broadcast_to(x.values, len(group)) for x in motion.state(mp, number(mp, time))]
                for mp in (WIDE, FLOAT)
            )
            self.found[:, k, group] = fine
            apart = np.max([abs(x - y) for x, y in zip(fine, rough, strict=True)], axis=0)
            scale = self._scale(k, group)
            late |= ~(apart <= _TRUSTED * scale)  # nan is not
            self.error[k, group] = apart * FLOAT.type(WIDE.eps / FLOAT.eps) + _UNIT * scale
        if len(group) > self._largest:
            self._largest, self.method = len(group), f"{motion.method}, in long double"
        self._leave(group[late])

    def _late(self, group: Array, motion: Motion) -> Array:
        """Which blow up before the last of the times, or nearly."""
        import numpy as np

        late = np.zeros(len(group), bool)
        for sign in (1, -1):
            last = max((sign * time for time in self.times), default=Fraction(0))
            end = motion.blow_up(WIDE, sign) if last > 0 else None
            if end is not None:
                end = end.values if isinstance(end, Batch) else end
                late |= ~(end * _BEFORE > float(last))
        return late

    def _scale(self, k: int, group: Array) -> Array:
        """The largest of |p| and |q| at both ends, for each of the points."""
        import numpy as np

        ends = (self.p[group], self.q[group], *self.found[:, k, group])
        return np.max(np.abs(ends), axis=0)

    # -- without ------------------------------------------------------------------------------

    def numerically(self) -> None:
        """All points twice, by extrapolations of two orders."""
        import numpy as np

        fine, rough = (follow(self.hamiltonian, self.p, self.q, self.times, n) for n in (8, 7))
        self.found[:] = fine
        every = np.arange(len(self.p))
        for k in range(len(self.times)):
            apart = np.max(abs(fine[:, k] - rough[:, k]), axis=0)
            scale = self._scale(k, every)
            self._leave(every[~(apart <= _TRUSTED_NUMERICAL * scale)])
            self.error[k] = apart + _UNIT * scale
        self.method = "numerical flow: Gragg's method, extrapolated, in long double"

    # -- against the exact solution -----------------------------------------------------------

    def one_by_one(self) -> None:
        """Those that were kept for later. Raises NoFlowError."""
        for i in sorted(self.alone):
            for k in range(len(self.times)):
                self.found[:, k, i], bound = self._exact(i, k)
                self.error[k, i] = bound + _UNIT * self._scale(k, [i])[0]

    def _exact(self, i: int, k: int) -> tuple[tuple[float, float], float]:
        p, q = Fraction(self.p[i]), Fraction(self.q[i])
        time = self.times[k]
        try:
            found = exact_solution(self.hamiltonian, p=p, q=q, time=time, digits=_DIGITS)
            return (float(found.p), float(found.q)), float(found.bound)
        except (NoFlowError, OverflowError) as error:
            said = error.said if isinstance(error, NoFlowError) else "it is beyond float64"
            where = f"point {i}, q = `{self.q[i]:.6g}`, p = `{self.p[i]:.6g}`"
            at = read_prose(f"{where}, to t = `{float(time):.6g}`: ")
            raise NoFlowError(at + said) from None

    def checked(self, most: int) -> Points:
        """What was found, where the sample's errors are no larger than they are estimated."""
        estimated = _SAFETY * float(self.error.max(initial=0.0))
        # Digits of a numerical flow take long: it is held at the longest time.
        every = sorted(range(len(self.times)), key=lambda k: abs(self.times[k]))
        held = every if most == _SAMPLE else every[-1:]
        worst = 0.0
        for i in self._sample(most):
            for k in held:
                true, bound = self._exact(i, k)
                error = max(abs(x - y) for x, y in zip(self.found[:, k, i], true, strict=True))
                worst = max(worst, float(error) + bound)
                if error > _SAFETY * estimated:
                    raise NoFlowError(
                        f"point {i} is wrong by `{error:.2g}` at t = `{float(self.times[k]):.6g}`, "
                        f"where `{estimated:.2g}` was estimated"
                    )
        bound = max(estimated, _SAFETY * worst)
        p, q = self.found
        return Points(p, q, bound, self.method, tuple(sorted(self.alone)))

    def _sample(self, most: int) -> list[int]:
        """Points found together: those with extreme p and q, and others evenly between."""
        import numpy as np

        together = np.setdiff1d(np.arange(len(self.p)), sorted(self.alone))
        if len(together) <= most:
            return [int(i) for i in together]
        p, q = self.p[together], self.q[together]
        ends = (p.argmax(), q.argmin(), q.argmax(), p.argmin())[: max(1, most - 2)]
        evenly = np.linspace(0, len(together) - 1, most - len(ends)).round().astype(int)
        return sorted({int(together[i]) for i in (*ends, *evenly)})
