"""Functions that run in turn and meet where what they ask for can be done together.

Such a function is a generator, a `Course`: it yields what it asks of a `Work`, by `meet`, and goes
on when that is there. `together` runs several of them, one at a time, until all wait, or have
ended; then one work does some of what is asked of it, as orbits of one kernel are stepped in the
lanes of the vector unit. `alone` runs a single one.

Contract: each gives what it gives alone. What a `Work` gives must not depend on what is done beside
it. Not promised: which of them ends first. Who waits holds what it holds: it must not meet while it
has changed what others see, such as flint's precision.
"""

import inspect
import threading
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

T = TypeVar("T")


class Work(Protocol):
    """What can be done for several together."""

    def advance(self, pending: "Sequence[Pending]") -> None:
        """Does some of what is asked; at least one of them is finished then.

        They come in the order in which they wait, and the first is among those that go on.
        """


class Pending:
    """What somebody asks of a work, until its result or its error is there.

    `state` is the work's own, for what is done in part; `seconds` what that has taken for this one,
    its share where it was done together with others.
    """

    __slots__ = ("asked", "error", "finished", "result", "seconds", "state", "work")

    def __init__(self, work: Work, asked: Any) -> None:
        self.work, self.asked = work, asked
        self.finished = False
        self.result: Any = None
        self.error: Exception | None = None
        self.state: Any = None
        self.seconds = 0.0

    def end(self, result: Any, error: Exception | None = None) -> None:
        """Called by the work: this one is finished."""
        self.result, self.error, self.finished = result, error, True


Course: TypeAlias = Generator[Pending, None, T]


def meet(work: Work, asked: Any) -> Course[Any]:
    """What the work makes of this, together with what others ask of it; errors are raised."""
    pending = Pending(work, asked)
    yield pending
    if pending.error is not None:
        raise pending.error
    return pending.result


def alone(course: Course[T]) -> T:
    """What it gives with no other beside it. What a work raises, it may catch."""
    error: BaseException | None = None
    while True:
        try:
            pending = next(course) if error is None else course.throw(error)
            error = None
            while not pending.finished:
                pending.work.advance([pending])
        except StopIteration as ended:
            result: T = ended.value
            return result
        except BaseException as raised:
            if not _waits(course):
                raise
            error = raised


def _waits(course: Course[Any]) -> bool:
    """Whether it has begun, and has not ended."""
    return inspect.getgeneratorstate(course) == inspect.GEN_SUSPENDED


class _Here(threading.local):
    """Of the course that runs in this thread: the seconds for which others ran since it began."""

    away = 0.0


_HERE = _Here()


def clock() -> float:
    """Seconds for which this course has run, what was done for it by a work among them."""
    return time.perf_counter() - _HERE.away


class Ended(Generic[T]):
    """What a course gave."""

    __slots__ = ("_error", "_value")

    def __init__(self, value: T | None, error: Exception | None = None) -> None:
        self._value, self._error = value, error

    def result(self) -> T:
        """Its value; what it raised is raised."""
        if self._error is not None:
            raise self._error
        return self._value  # type: ignore[return-value]  # T may be None


def together(courses: Iterator[Course[T]], most: int) -> Iterator[tuple[int, Ended[T]]]:
    """(its number, what it gave) of each course as it ends; `most` are under way at a time.

    The courses are taken from their iterator as there is room. Where this is left before its end,
    those under way are ended where they wait: a KeyboardInterrupt is raised in them as well.
    """
    numbered = enumerate(courses)
    waiting: list[_Member[T]] = []
    reason: BaseException = GeneratorExit()
    try:
        while True:
            while len(waiting) < most and (following := next(numbered, None)) is not None:
                member = _Member(*following)
                waiting.append(member)
                member.go_on()
                if member.ended is not None:
                    waiting.remove(member)
                    yield member.number, member.ended
            if not waiting:
                return
            _advance(waiting)
            for member in [member for member in waiting if member.ready]:
                member.go_on()
                others = [other for other in waiting if other is not member]
                # In one assignment: an interruption may come at any time, and is everybody's.
                waiting = others if member.ended else [*others, member]
                if member.ended is not None:
                    yield member.number, member.ended
    except KeyboardInterrupt as error:
        reason = error
        raise
    finally:
        for member in waiting:
            member.end(reason)


def _advance(waiting: "Sequence[_Member[Any]]") -> None:
    """The work that is waited for longest is done, for all who wait for it.

    So nobody waits for ever, and who is behind the others is not left behind.
    """
    asked = [member.pending for member in waiting if member.pending is not None]
    work = asked[0].work
    work.advance([pending for pending in asked if pending.work is work])


class _Member(Generic[T]):
    """A course under way: it runs while `go_on` is called, until it waits for a work or ends."""

    def __init__(self, number: int, course: Course[T]) -> None:
        self.number, self.course = number, course
        self.ended: Ended[T] | None = None
        self.pending: Pending | None = None
        self.away = self.since = 0.0  # seconds for which others ran; when it began to wait

    @property
    def ready(self) -> bool:
        """Whether what it waits for is done."""
        return self.pending is not None and self.pending.finished

    def go_on(self) -> None:
        """An interruption of it is raised."""
        if self.pending is not None:
            self.away += time.perf_counter() - self.since - self.pending.seconds
        outer, _HERE.away = _HERE.away, self.away
        try:
            self.pending = next(self.course)
        except StopIteration as ended:
            self.ended = Ended(ended.value)
        except Exception as error:
            self.ended = Ended(None, error)
        finally:
            _HERE.away = outer
            self.since = time.perf_counter()

    def end(self, reason: BaseException) -> None:
        """Ends it where it waits, if it does."""
        if _waits(self.course):
            with suppress(BaseException):
                self.course.throw(reason)
