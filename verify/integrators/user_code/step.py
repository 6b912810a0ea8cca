"""A call of a user's own function: where its output goes, what it may return, how long it may take.

Its output goes to standard error. A call that does not return is interrupted if this thread
receives signals.
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

Theirs: TypeAlias = Any  # a value that a user's code takes, holds or returns: it may be anything
T = TypeVar("T")
TIME_LIMIT = 60.0  # seconds; all calls of the user's code together
# Seconds until the first alarm, at least, and between later ones. One alarm does not suffice:
# Python drops an exception that is raised within a finalizer or a callback of its garbage
# collector, and a bare `except:` in the user's code catches it.
_FIRST_ALARM, _NEXT_ALARM = 0.01, 1.0


class StepError(Exception):
    """The error of a function that did something other than a step.

    `clause`: the message for people, one clause that begins with "it".
    """

    def __init__(self, clause: str) -> None:
        self.clause = prose(clause)
        super().__init__(self.clause)


class _OverTimeError(BaseException):  # so that `except Exception` in the user's code lets it pass
    pass


def last_line(error: BaseException) -> str:
    """Format the user's exception as the last line of Python's traceback, its message cut after the
    first line."""
    lines = str(error).split("\n")
    return f"{type(error).__name__}: {lines[0]}" if lines[0] else type(error).__name__


@contextlib.contextmanager
def contain_effects() -> Iterator[None]:
    """Contain what the user's code does to this process while the body runs.

    Its output goes to standard error, since standard output holds JSON alone. `os._exit` acts as
    `sys.exit`, since it would end this program without a message.
    """
    end, process = os._exit, os.getpid()

    def stop(status: int) -> NoReturn:
        if os.getpid() != process:  # the call comes from a process that the user's code has forked
            end(status)
        raise SystemExit(status)

    os._exit = stop
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        os._exit = end


class Limited(Protocol):
    """Code whose calls have a limited number of seconds left."""

    @property
    def seconds_left(self) -> float: ...


@contextlib.contextmanager
def limit_call(owner: Limited, too_long: str = "a call of it does not end") -> Iterator[None]:
    """Guard a call of a user's code: its output, its exits, and the time that it takes.

    Raises StepError if no time is left, if the call takes longer, or if the code exits.
    """
    if owner.seconds_left <= 0:
        raise StepError("its calls took all the time that there is")
    try:
        with (
            contain_effects(),
            limit_time(owner.seconds_left, f"{too_long} within {owner.seconds_left:.3g} s"),
        ):
            yield
    except SystemExit:
        raise StepError("it calls sys.exit, or os._exit") from None


@contextlib.contextmanager
def limit_time(seconds: float, problem: str) -> Iterator[None]:
    """Raise StepError with this problem if the body does not end in time.

    Limits may be nested: the time of an outer limit goes on, and if the outer one ends first, it
    alone applies. In other threads than the main one, and on systems without alarms, the body is
    not limited.
    """
    error, has_ended = _OverTimeError(problem), False

    def raise_late(*_: object) -> None:
        if not has_ended:  # the alarm may ring when the body has just ended
            raise error

    has_timer = hasattr(signal, "getitimer")
    outer_seconds = signal.getitimer(signal.ITIMER_REAL)[0] if has_timer else 0.0
    previous_handler = None
    if not 0 < outer_seconds <= seconds:  # otherwise the outer limit ends first
        with contextlib.suppress(ValueError, AttributeError):
            previous_handler = signal.signal(signal.SIGALRM, raise_late)
    if previous_handler is None:
        yield
        return
    start = time.perf_counter()
    try:
        # With less than `_FIRST_ALARM` it could ring before the body has begun, where no handler
        # below would catch the error.
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
        signal.signal(signal.SIGALRM, previous_handler)
        if outer_seconds:
            rest = outer_seconds - (time.perf_counter() - start)
            signal.setitimer(signal.ITIMER_REAL, max(rest, _FIRST_ALARM), _NEXT_ALARM)


def unless_it_fails(call: Callable[[], T]) -> T | None:
    """Return the result of a call of the user's code, or None if it raises any exception."""
    try:
        return call()
    except Exception:
        return None


def lift_numbers(first: Theirs, result: Sequence[Theirs]) -> list[Theirs]:
    """Return the result as numbers of the class of `first`. Raises StepError if one is not."""
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
