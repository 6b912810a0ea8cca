"""A user's own step function as it is called: with what, what it returns, and for how long.

What it prints goes to standard error, and a call that does not come back is ended where this thread
gets signals.
"""

import contextlib
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, NoReturn, Protocol, TypeAlias, TypeVar

from verify.errors import InputError
from verify.integrators.number_type import DOUBLE, NumberType
from verify.integrators.tracing.number import TracedNumber, UntraceableError
from verify.prose import Number, Prose, prose, read_prose

Theirs: TypeAlias = Any  # what a user's code takes, holds or returns: it may be anything
State = tuple[float, float]
Real = TypeVar("Real", float, Fraction)
TIME_LIMIT = 60.0  # seconds for all of the user's code


class StepError(Exception):
    """What the user's function did instead of a step: `said`, one clause, "it …", for people."""

    def __init__(self, said: str) -> None:
        self.said = prose(said)
        super().__init__(self.said)


class _OverTimeError(BaseException):  # so that `except Exception` in the user's code lets it pass
    pass


def last_line(error: BaseException) -> str:
    """The user's exception as Python's last line of a traceback has it."""
    lines = str(error).split("\n")
    return f"{type(error).__name__}: {lines[0]}" if lines[0] else type(error).__name__


@contextlib.contextmanager
def contained() -> Iterator[None]:
    """Around code of a user's: what it prints goes to standard error, as JSON stands alone on
    standard output, and `os._exit` is as `sys.exit`, as it would end this program without a word.
    """
    end, own = os._exit, os.getpid()

    def stopped(status: int) -> NoReturn:
        if os.getpid() != own:  # a process that it has forked
            end(status)
        raise SystemExit(status)

    os._exit = stopped
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        os._exit = end


@dataclass
class Step:
    """The user's step(p, q, h) → (p', q'), or step(p, q, t, h).

    `order`: its arguments by their names here, such as ("q", "p", "h"); what it returns stands in
    that order too. `moving`: whether it is for an H that depends on time; else its t, where it
    takes one, is 0. `given`: parameters of H that it takes by name. `arrays`: it wants p and q as
    arrays, and gets them with one entry each. `left`: seconds left for its calls. `numbers`: the
    type that it computes in. `foreign`: it is of another language, so that numbers alone go in.
    `periods`: of p and q, where it is seen to reduce them so (`verify.integrators.wrapped`).
    """

    function: Callable[..., Theirs]
    order: tuple[str, ...] = ("p", "q", "h")
    given: Mapping[str, float] = field(default_factory=dict)
    arrays: bool = False
    left: float = TIME_LIMIT
    moving: bool = False
    numbers: NumberType = DOUBLE
    foreign: bool = False
    periods: tuple[Fraction, ...] = ()

    @property
    def ways(self) -> tuple[str, ...]:
        """In which it can be measured, the clearest first."""
        return ("floats",) if self.foreign else ("duals", "floats")

    @property
    def timed(self) -> bool:
        """Whether it takes t."""
        return "t" in self.order

    def clock(self, p: Real, q: Real) -> Real:
        """The t at which it is called at a point: another one at every point."""
        return (1 + 2 * p + q) / 4 if self.moving else type(p)(0)

    def raw(
        self, function: Callable[..., Theirs], p: Theirs, q: Theirs, h: Theirs, t: Theirs = 0.0
    ) -> Theirs:
        """What the function, or a copy of it, returns."""
        by_name = {"p": p, "q": q, "h": h, "t": t}
        return function(*(by_name[name] for name in self.order), **self.given)

    def called(
        self, function: Callable[..., Theirs], p: Theirs, q: Theirs, h: Theirs, t: Theirs = 0.0
    ) -> Theirs:
        """The same at one point; with arrays of one entry where it wants arrays."""
        if not self.arrays:
            return self.raw(function, p, q, h, t)
        import numpy as np

        boxes = [np.empty(1, dtype=float if isinstance(x, float) else object) for x in (p, q)]
        boxes[0][0], boxes[1][0] = p, q
        return self.raw(function, boxes[0], boxes[1], h, t)

    def at(self, p: float, q: float, h: float, t: float | None = None) -> State:
        """(p', q') as floats; without t at the point's own. Raises StepError, also for what is not
        finite."""
        with self.limited():
            return self._floats(p, q, h, self.clock(p, q) if t is None else t)

    def _floats(self, p: float, q: float, h: float, t: float) -> State:
        x, y = map(real, self.pair(self.called(self.function, p, q, h, t)))
        if x - x != 0 or y - y != 0:
            found = prose(Number(f"{x:g}"), ", ", Number(f"{y:g}"))
            raise StepError(prose("it returns ", found, line_of_error(p, q, h)))
        return x, y

    def rounded(self, x: Fraction) -> Fraction:
        """The nearest number of its type, within its range."""
        return self.numbers.rounded(x)

    def exactly(
        self, points: Sequence[Sequence[Fraction]], h: Fraction, t: Fraction
    ) -> list[list[Fraction]]:
        """(p', q') of each (p, q), as the numbers of its type that they are, in one limit of time,
        which takes longer to set than many a step. Raises StepError, as `at`."""
        with limited(self, "calls of it do not end"):
            return [[Fraction(x) for x in self._of_its_type(p, q, h, t)] for p, q in points]

    def _of_its_type(self, p: Fraction, q: Fraction, h: Fraction, t: Fraction) -> Sequence[Theirs]:
        if self.numbers is DOUBLE:
            return self._floats(float(p), float(q), float(h), float(t))
        return self.pair(self.called(self.function, p, q, h, t))

    def pair(self, result: Theirs) -> tuple[Theirs, Theirs]:
        """p' and q' of what was returned, each a single number. Raises StepError."""
        parts = _parts(result)
        if self.order.index("p") > self.order.index("q"):
            parts.reverse()
        return single(parts[0]), single(parts[1])

    def limited(self) -> contextlib.AbstractContextManager[None]:
        """Around every call: what it prints, what it raises, and how long it takes."""
        return limited(self)


class Limited(Protocol):
    """Code whose calls have so many seconds left."""

    left: float


@contextlib.contextmanager
def limited(owner: Limited, too_long: str = "a call of it does not end") -> Iterator[None]:
    """Around every call of a user's code: what it prints, what it raises, and how long it takes."""
    if owner.left <= 0:
        raise StepError("its calls took all the time that there is")
    begun = time.perf_counter()
    try:
        with contained(), within(owner.left, f"{too_long} within {owner.left:.3g} s"):
            yield
    except SystemExit:
        raise StepError("it calls sys.exit, or os._exit") from None
    finally:
        owner.left -= time.perf_counter() - begun


@contextlib.contextmanager
def within(seconds: float, problem: str) -> Iterator[None]:
    """StepError with this problem where what is done here does not end in time.

    It may stand in another one, whose time goes on. In other threads than the main one, and on
    systems without alarms, there is no limit.
    """
    error = _OverTimeError(problem)

    def late(*_: object) -> None:
        raise error

    try:
        before = signal.signal(signal.SIGALRM, late)
    except (ValueError, AttributeError):
        yield
        return
    outer, _ = signal.setitimer(signal.ITIMER_REAL, seconds)
    begun = time.perf_counter()
    try:
        yield
    except _OverTimeError as raised:
        if raised is not error:
            raise
        raise StepError(problem) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        if outer:
            spent = time.perf_counter() - begun
            signal.setitimer(signal.ITIMER_REAL, max(outer - spent, 1e-3))


def line_of_error(p: float, q: float, h: float) -> Prose:
    return read_prose(f" at p = `{p:g}`, q = `{q:g}`, h = `{h:g}`")


def _parts(result: Theirs) -> list[Theirs]:
    if result is None:
        raise StepError("it returns None; wanted: p', q'")
    if isinstance(result, str | bytes):
        raise StepError("it returns text; wanted: p', q'")
    try:
        parts = list(result)
    except TypeError:
        raise StepError(f"it returns one {type(result).__name__}; wanted: p', q'") from None
    if isinstance(result, dict | set) or len(parts) != 2:
        count = f"a {type(result).__name__} of {len(parts)}"
        raise StepError(f"it returns {count}; wanted: a pair p', q'")
    return parts


def single(x: Theirs) -> Theirs:
    shape = getattr(x, "shape", ())
    if shape:
        if any(n != 1 for n in shape):
            raise StepError(f"it returns arrays of shape {tuple(shape)} for a single p, q")
        return x.reshape(-1)[0]
    return x[()] if hasattr(x, "dtype") and hasattr(x, "reshape") else x


def lifted(first: Theirs, found: Sequence[Theirs]) -> list[Theirs]:
    """What was returned, all as numbers of the kind of `first`. Raises StepError."""
    zero = first * 0
    made = [zero + x for x in found]
    if any(type(x) is not type(first) for x in made):
        raise StepError("it returns what is no number")
    return made


def why(error: Exception) -> Prose:
    """What is said of an error that the user's code, or what we do with it, raised."""
    known = isinstance(error, UntraceableError | StepError | InputError)
    return prose(error.args[0] if known and error.args else last_line(error))


def real(x: Theirs) -> float:
    if isinstance(x, str | bytes | bytearray) or x is None or isinstance(x, TracedNumber):
        raise StepError(f"it returns {'text' if isinstance(x, str) else type(x).__name__}")
    if isinstance(x, complex):
        raise StepError("it returns complex numbers")
    try:
        return float(x)
    except (TypeError, ValueError):
        raise StepError(f"it returns a pair of {type(x).__name__}; wanted: numbers") from None
