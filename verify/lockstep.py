"""Functions that run in turn and meet where what they ask for can be done together.

Contract: `together` calls functions so that one of them runs at a time, and each as if it ran by
itself: what a `Work` gives must not depend on what is done beside it. Where a function calls
`meet`, it waits until all others wait too, or have ended; then one work does some of what is asked
of it, as orbits of one kernel are stepped in the lanes of the vector unit.

Not promised: which function ends first. A function that waits holds what it holds: it must not meet
while it has changed what others see, such as flint's precision.

Each function is a greenlet, a stack of its own in this thread: to let another one run takes a
microsecond, where threads that wait for each other take some fifty.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Generic, Protocol, TypeVar

import greenlet

T = TypeVar("T")


class Pending:
    """What somebody asks of a work, until its result or its error is there.

    `state` is the work's own, for what is done in part; `seconds` what that has taken for this one,
    its share where it was done together with others.
    """

    __slots__ = ("asked", "error", "finished", "result", "seconds", "state")

    def __init__(self, asked: Any) -> None:
        self.asked = asked
        self.finished = False
        self.result: Any = None
        self.error: Exception | None = None
        self.state: Any = None
        self.seconds = 0.0

    def end(self, result: Any, error: Exception | None = None) -> None:
        """Called by the work: this one is finished."""
        self.result, self.error, self.finished = result, error, True


class Ended(Generic[T]):
    """What a function gave."""

    __slots__ = ("_error", "_value")

    def __init__(self, value: T | None, error: BaseException | None = None) -> None:
        self._value, self._error = value, error

    @property
    def interruption(self) -> BaseException | None:
        """What ended it, where that is everybody's."""
        return None if isinstance(self._error, Exception) else self._error

    def result(self) -> T:
        """Its value; what it raised is raised."""
        if self._error is not None:
            raise self._error
        return self._value  # type: ignore[return-value]  # T may be None


class Work(Protocol):
    """What can be done for several together."""

    def advance(self, pending: Sequence[Pending]) -> None:
        """Does some of what is asked; at least one of them is finished then.

        They come in the order in which they wait, and the first is among those that go on.
        """


def meet(work: Work, asked: Any) -> Pending:
    """What the work makes of this, together with what others ask of it; errors are raised."""
    pending = Pending(asked)
    here = greenlet.getcurrent()
    if isinstance(here, _Member):
        here.wait(work, pending)
    while not pending.finished:
        work.advance([pending])
    if pending.error is not None:
        raise pending.error
    return pending


def clock() -> float:
    """Seconds for which this function has run, what was done for it by a work among them."""
    here = greenlet.getcurrent()
    return time.perf_counter() - (here.away if isinstance(here, _Member) else 0.0)


def together(functions: Iterator[Callable[[], T]], most: int) -> "Iterator[tuple[int, Ended[T]]]":
    """(its number, what it gave) of each function as it ends; `most` are under way at a time.

    The functions are taken from their iterator as there is room. Where this is left before its end,
    those under way are ended where they wait: a KeyboardInterrupt is raised in them as well.
    """
    numbered = enumerate(functions)
    waiting: list[_Member] = []
    reason: BaseException = greenlet.GreenletExit()
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


def _advance(waiting: Sequence["_Member"]) -> None:
    """The work that is waited for longest is done, for all who wait for it.

    So nobody waits for ever, and who is behind the others is not left behind.
    """
    work = waiting[0].work
    assert work is not None  # noqa: S101 - it waits for it
    work.advance([e.pending for e in waiting if e.work is work and e.pending is not None])


class _Member(greenlet.greenlet):
    """A function under way: it runs while `go_on` is called, until it waits for a work or ends."""

    def __init__(self, number: int, function: Callable[[], Any]) -> None:
        super().__init__(self._whole)
        self.number, self.function = number, function
        self.ended: Ended[Any] | None = None
        self.work: Work | None = None
        self.pending: Pending | None = None
        self.away = 0.0  # seconds for which others ran since it began

    @property
    def ready(self) -> bool:
        """Whether what it waits for is done."""
        return self.pending is not None and self.pending.finished

    def go_on(self) -> None:
        self.parent = greenlet.getcurrent()
        self.switch()
        if self.ended is not None and self.ended.interruption is not None:
            raise self.ended.interruption

    def end(self, reason: BaseException) -> None:
        """Ends it where it waits, if it does."""
        if self:  # it has begun, and has not ended
            self.parent = greenlet.getcurrent()
            self.throw(type(reason), reason)

    def wait(self, work: Work, pending: Pending) -> None:
        """Called by the function itself: until what is pending is done."""
        self.work, self.pending = work, pending
        begun = time.perf_counter()
        try:
            assert self.parent is not None  # noqa: S101 - whoever let it run
            self.parent.switch()
        finally:
            self.away += time.perf_counter() - begun - pending.seconds
            self.work = self.pending = None

    def _whole(self) -> None:
        try:
            self.ended = Ended(self.function())
        except BaseException as error:
            self.ended = Ended(None, error)
