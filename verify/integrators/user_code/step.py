"""A call of a user's own function: what it may print, what it returns, and for how long.

What it prints goes to standard error, and a call that does not come back is ended where this thread
gets signals.
"""

import contextlib
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NoReturn, Protocol, TypeAlias, TypeVar

from verify.errors import InputError
from verify.integrators.tracing.traced_number import TracedNumber, UntraceableError
from verify.prose import Prose, prose

Theirs: TypeAlias = Any  # what a user's code takes, holds or returns: it may be anything
T = TypeVar("T")
TIME_LIMIT = 60.0  # seconds for all of the user's code
# Python drops what is raised within a finalizer or a callback of its garbage collector, and a bare
# `except:` of the user's catches it: the alarm rings again after so many seconds.
_NEXT_ALARM, _FIRST_ALARM = 1.0, 0.01


class StepError(Exception):
    """The error of a function that did something else than a step: `said`, one clause, "it …", for
    people."""

    def __init__(self, said: str) -> None:
        self.said = prose(said)
        super().__init__(self.said)


class _OverTimeError(BaseException):  # so that `except Exception` in the user's code lets it pass
    pass


def last_line(error: BaseException) -> str:
    """Format the user's exception as Python's last line of a traceback has it."""
    lines = str(error).split("\n")
    return f"{type(error).__name__}: {lines[0]}" if lines[0] else type(error).__name__


@contextlib.contextmanager
def contain_effects() -> Iterator[None]:
    """Run code of a user's so that what it prints goes to standard error, as JSON stands alone on
    standard output, and `os._exit` is as `sys.exit`, as it would end this program without a
    word."""
    end, process = os._exit, os.getpid()

    def stop(status: int) -> NoReturn:
        if os.getpid() != process:  # a process that it has forked
            end(status)
        raise SystemExit(status)

    os._exit = stop
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        os._exit = end


class Limited(Protocol):
    """Code whose calls have so many seconds left."""

    @property
    def left(self) -> float: ...


@contextlib.contextmanager
def limit_call(owner: Limited, too_long: str = "a call of it does not end") -> Iterator[None]:
    """Guard a call of a user's code: what it prints, what it raises, and how long it takes."""
    if owner.left <= 0:
        raise StepError("its calls took all the time that there is")
    try:
        with contain_effects(), limit_time(owner.left, f"{too_long} within {owner.left:.3g} s"):
            yield
    except SystemExit:
        raise StepError("it calls sys.exit, or os._exit") from None


@contextlib.contextmanager
def limit_time(seconds: float, problem: str) -> Iterator[None]:
    """Raise StepError with this problem where the body does not end in time.

    It may stand in another one, whose time goes on. In other threads than the main one, and on
    systems without alarms, there is no limit.
    """
    error, has_ended = _OverTimeError(problem), False

    def late(*_: object) -> None:
        if not has_ended:  # it may be late for what has just ended
            raise error

    outer = signal.getitimer(signal.ITIMER_REAL)[0] if hasattr(signal, "getitimer") else 0.0
    before = None
    if not 0 < outer <= seconds:  # else the outer limit ends first
        with contextlib.suppress(ValueError, AttributeError):
            before = signal.signal(signal.SIGALRM, late)
    if before is None:
        yield
        return
    start = time.perf_counter()
    try:
        # Sooner it could ring before what is done here has begun, where nobody would take it.
        signal.setitimer(signal.ITIMER_REAL, max(seconds, _FIRST_ALARM), _NEXT_ALARM)
        yield
        has_ended = True
    except _OverTimeError as raised:
        has_ended = True
        if raised is not error:
            raise
        raise StepError(problem) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        if outer:
            spent = time.perf_counter() - start
            signal.setitimer(signal.ITIMER_REAL, max(outer - spent, _FIRST_ALARM), _NEXT_ALARM)


def unless_it_fails(call: Callable[[], T]) -> T | None:
    """Return the result of a call of the user's code; None where it raises, which may be
    anything."""
    try:
        return call()
    except Exception:
        return None


def lift_numbers(first: Theirs, result: Sequence[Theirs]) -> list[Theirs]:
    """Return the result as numbers of the kind of `first`. Raises StepError."""
    zero = first * 0
    numbers = [zero + x for x in result]
    if any(type(x) is not type(first) for x in numbers):
        raise StepError("it returns what is no number")
    return numbers


def describe_error(error: Exception) -> Prose:
    """Describe an error that the user's code, or what we do with it, raised."""
    is_ours = isinstance(error, UntraceableError | StepError | InputError)
    return prose(error.args[0] if is_ours and error.args else last_line(error))


def to_float(x: Theirs) -> float:
    if isinstance(x, str | bytes | bytearray) or x is None or isinstance(x, TracedNumber):
        raise StepError(f"it returns {'text' if isinstance(x, str) else type(x).__name__}")
    if isinstance(x, complex):
        raise StepError("it returns complex numbers")
    try:
        return float(x)
    except (TypeError, ValueError):
        raise StepError(f"it returns a pair of {type(x).__name__}; wanted: numbers") from None
