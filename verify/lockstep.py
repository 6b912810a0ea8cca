"""Functions that take turns, and wait until their requests can be served together.

Such a function is a generator, a `Course`: by `meet` it yields a request to a `Work`, and continues
when the result exists. `run_together` runs several courses, one at a time, until all wait or have
ended; then one work serves some of the requests to it. For example, orbits of one kernel are
stepped together in the lanes of the vector unit. `run_alone` runs a single course.

Contract: each course returns the same value as alone. The result of a request to a `Work` must not
depend on the requests that are served with it. Not promised: which course ends first. While a
course waits, it must not have changed a state that others see, such as flint's precision.
"""

import inspect
import threading
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

T = TypeVar("T")


class Work(Protocol):
    """A computation that can serve several requests together."""

    def advance(self, pending: "Sequence[Pending]") -> None:
        """Serve some of the requests, and finish at least one of them.

        The one that has waited longest comes first, and must be among those served.
        """


class Pending:
    """A request to a work, which becomes finished with a result or an error.

    `state` belongs to the work, for a request that is served in part. `seconds` is the time that
    this request has taken; if it was served together with others, its share of their time.
    """

    __slots__ = ("error", "finished", "request", "result", "seconds", "state", "work")

    def __init__(self, work: Work, request: Any) -> None:
        self.work, self.request = work, request
        self.finished = False
        self.result: Any = None
        self.error: Exception | None = None
        self.state: Any = None
        self.seconds = 0.0

    def end(self, result: Any, error: Exception | None = None) -> None:
        """Finish the request; called by the work."""
        self.result, self.error, self.finished = result, error, True


Course: TypeAlias = Generator[Pending, None, T]


def meet(work: Work, request: Any) -> Course[Any]:
    """Return the work's result for the request, or raise its error; other requests may join it."""
    pending = Pending(work, request)
    yield pending
    if pending.error is not None:
        raise pending.error
    return pending.result


def run_alone(course: Course[T]) -> T:
    """Run one course to its end, and return its value. The course may catch errors of a work."""
    error: BaseException | None = None
    while True:
        try:
            pending = next(course) if error is None else course.throw(error)
            error = None
            while not pending.finished:
                pending.work.advance([pending])
        except StopIteration as stop:
            result: T = stop.value
            return result
        except BaseException as exception:
            # An error of the course itself has ended it, and goes to the caller. If the course is
            # suspended, `advance` raised the error: it is thrown into the course at its `yield`.
            if not _is_suspended(course):
                raise
            error = exception


def _is_suspended(course: Course[Any]) -> bool:
    """Return True if the course has begun and has not ended."""
    return inspect.getgeneratorstate(course) == inspect.GEN_SUSPENDED


class _ThreadState(threading.local):
    """The seconds for which other courses have run since the course of this thread began."""

    seconds_away = 0.0


_THREAD_STATE = _ThreadState()


def clock() -> float:
    """Return a time in seconds that advances only while this course, or work for it, runs."""
    return time.perf_counter() - _THREAD_STATE.seconds_away


class CourseOutcome(Generic[T]):
    """The value of a course that has ended, or its error."""

    __slots__ = ("_error", "_value")

    def __init__(self, value: T | None, error: Exception | None = None) -> None:
        self._value, self._error = value, error

    def result(self) -> T:
        """Return the value, or raise the error."""
        if self._error is not None:
            raise self._error
        return self._value  # type: ignore[return-value]  # T may be None


def run_together(
    courses: Iterator[Course[T]], max_active: int
) -> Iterator[tuple[int, CourseOutcome[T]]]:
    """Run the courses, and yield the number and the outcome of each as it ends.

    At most `max_active` courses are under way at a time; when one ends, the next is taken from the
    iterator. If the caller leaves before the end, GeneratorExit is raised in each course that
    waits, or KeyboardInterrupt if that is why the caller leaves.
    """
    numbered = enumerate(courses)
    waiting: list[_Member[T]] = []
    # The exception that ends waiting courses, in which each can save its state.
    reason: BaseException = GeneratorExit()
    try:
        while True:
            while len(waiting) < max_active and (following := next(numbered, None)) is not None:
                member = _Member(*following)
                waiting.append(member)
                member.resume()
                if member.outcome is not None:
                    waiting.remove(member)
                    yield member.number, member.outcome
            if not waiting:
                return
            _advance(waiting)
            for member in [member for member in waiting if member.is_ready]:
                member.resume()
                remaining = [m for m in waiting if m is not member]
                # One assignment, as an interruption may come at any time, and `finally` ends them.
                waiting = remaining if member.outcome else [*remaining, member]
                if member.outcome is not None:
                    yield member.number, member.outcome
    except KeyboardInterrupt as error:
        reason = error
        raise
    finally:
        for member in waiting:
            member.end(reason)


def _advance(waiting: "Sequence[_Member[Any]]") -> None:
    """Let the work of the longest-waiting course serve all requests to it.

    So no course waits for ever, and one that is behind the others catches up.
    """
    requests = [member.pending for member in waiting if member.pending is not None]
    work = requests[0].work
    work.advance([pending for pending in requests if pending.work is work])


class _Member(Generic[T]):
    """A course under way: it runs while `resume` is called, until it waits for a work or ends."""

    def __init__(self, number: int, course: Course[T]) -> None:
        self.number, self.course = number, course
        self.outcome: CourseOutcome[T] | None = None
        self.pending: Pending | None = None
        # The seconds for which other courses ran; the time at which this one began to wait.
        self.seconds_away = self.wait_start = 0.0

    @property
    def is_ready(self) -> bool:
        """True if its request is finished."""
        return self.pending is not None and self.pending.finished

    def resume(self) -> None:
        """Run the course until its next request or its end; an Exception becomes its outcome."""
        # The course was away for the time that it has waited, less the seconds of its own request.
        if self.pending is not None:
            self.seconds_away += time.perf_counter() - self.wait_start - self.pending.seconds
        # A course may itself run others: the time of the outer one is restored below.
        outer_seconds, _THREAD_STATE.seconds_away = _THREAD_STATE.seconds_away, self.seconds_away
        try:
            self.pending = next(self.course)
        except StopIteration as stop:
            self.outcome = CourseOutcome(stop.value)
        except Exception as error:
            self.outcome = CourseOutcome(None, error)
        finally:
            _THREAD_STATE.seconds_away = outer_seconds
            self.wait_start = time.perf_counter()

    def end(self, reason: BaseException) -> None:
        """Raise `reason` in the course at its `yield`, if it waits; drop what it raises in turn."""
        if _is_suspended(self.course):
            with suppress(BaseException):
                self.course.throw(reason)
