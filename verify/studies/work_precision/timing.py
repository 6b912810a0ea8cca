"""Run times: repeated in rounds, the timer's and the call's own time subtracted.

The rounds go over all that is timed before any of it is timed again, so that a slow moment of the
machine falls on all alike. A call that is short is repeated within one timing until that is well
above the timer's resolution. Where the system can tell it, the time is the processor time of this
thread, so that what other programs take of the processor does not count.
"""

import gc
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import repeat
from statistics import median
from typing import Literal

Call = Callable[[], object]
_LEAST = 0.004  # seconds of one timing
_RESOLVED = 1e-6  # a clock this fine will do
_MOST_CALLS = 1 << 20
_FINEST = 1e-9  # seconds


@dataclass(frozen=True)
class Timed:
    """Seconds of one call, over the rounds."""

    least: float
    median: float


@cache
def clock() -> tuple[Callable[[], int], str]:
    """What tells nanoseconds, and what it is."""
    if hasattr(time, "thread_time_ns") and _resolution("thread_time") < _RESOLVED:
        return time.thread_time_ns, "processor time of the thread"
    return time.perf_counter_ns, "time on the clock"


def _resolution(name: Literal["thread_time"]) -> float:
    return time.get_clock_info(name).resolution


def interleaved(calls: Sequence[Call], rounds: int) -> list[Timed]:
    """Each call timed once in each round; every call is made once before, as a warm-up."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        counted = [_count(call) for call in calls]  # the first round
        found = [[taken] for _, taken in counted]
        for k in range(1, rounds):
            order = range(len(calls)) if k % 2 == 0 else reversed(range(len(calls)))
            for i in order:
                found[i].append(_seconds(calls[i], counted[i][0]))
    finally:
        if collecting:
            gc.enable()
    return [Timed(min(each), median(each)) for each in found]


def less(timed: Timed, blank: Timed) -> Timed:
    """The time without the least of the blank call; never below the clock's resolution."""
    return Timed(*(max(_FINEST, x - blank.least) for x in (timed.least, timed.median)))


def above(timed: Timed, blank: Timed) -> Timed | None:
    """The same; None where the blank call takes longer than what is left, which is then noise."""
    left = less(timed, blank)
    return None if left.median < blank.least else left


def nothing() -> None:
    """A call that does nothing: what timing itself takes."""


def _count(call: Call) -> tuple[int, float]:
    """So many calls that one timing of them is long enough, and the seconds of one of them."""
    call()
    count = 1
    while True:
        each = _seconds(call, count)
        if each * count >= _LEAST or count == _MOST_CALLS:
            return count, each
        # Not all at once: a first timing may be slow by chance.
        room = int(_LEAST / max(each, 1e-7 / count) / 2)
        count = min(_MOST_CALLS, max(2 * count, room))


def _seconds(call: Call, count: int) -> float:
    now, _ = clock()
    calls = repeat(None, count)
    begun = now()
    for _ in calls:
        call()
    return (now() - begun) / count / 1e9
