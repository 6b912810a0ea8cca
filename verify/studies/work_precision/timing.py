"""Run times: repeated in rounds, the timer's and the call's own time subtracted.

A round times each call once, so that a slow moment of the machine falls on all alike. A short call
is repeated within one timing until that is well above the timer's resolution. If the system
provides it, the time is the processor time of this thread, which does not count other programs.
"""

import gc
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import repeat
from statistics import median

Call = Callable[[], object]
_LEAST_SECONDS = 0.004  # of one timing
_COARSEST_RESOLUTION = 1e-6  # seconds; the thread's clock is used if it is finer
_MAX_CALLS = 1 << 20
_CLOCK_UNIT = 1e-9  # seconds; the clocks count nanoseconds


@dataclass(frozen=True)
class RunTime:
    """Seconds of one call, over the rounds."""

    least: float
    median: float


@cache
def choose_clock() -> tuple[Callable[[], int], str]:
    """Return the clock in nanoseconds, and its description."""
    has_clock = hasattr(time, "thread_time_ns")
    if has_clock and time.get_clock_info("thread_time").resolution < _COARSEST_RESOLUTION:
        return time.thread_time_ns, "processor time of the thread"
    return time.perf_counter_ns, "time on the clock"


def time_interleaved(calls: Sequence[Call], rounds: int) -> list[RunTime]:
    """Time each call once in each round; the first round is preceded by a warm-up of each call."""
    # A collection of garbage in the midst of a timing would be counted with it.
    collecting = gc.isenabled()
    gc.disable()
    try:
        counts = [_count(call) for call in calls]  # the first round
        seconds = [[first_seconds] for _, first_seconds in counts]
        for k in range(1, rounds):
            # Rounds alternate in direction, so that a steady change of the machine's speed falls on
            # all alike.
            order = range(len(calls)) if k % 2 == 0 else reversed(range(len(calls)))
            for i in order:
                seconds[i].append(_seconds(calls[i], counts[i][0]))
    finally:
        if collecting:
            gc.enable()
    return [RunTime(min(call_seconds), median(call_seconds)) for call_seconds in seconds]


def subtract_blank(time: RunTime, blank: RunTime) -> RunTime:
    """Subtract the least time of the blank call; never go below the clock's unit."""
    return RunTime(*(max(_CLOCK_UNIT, x - blank.least) for x in (time.least, time.median)))


def subtract_or_none(time: RunTime, blank: RunTime) -> RunTime | None:
    """Return `subtract_blank`, or None if the rest is below the blank call's time, and so noise."""
    net_time = subtract_blank(time, blank)
    return None if net_time.median < blank.least else net_time


def do_nothing() -> None:
    """Do nothing: the time of this call is that of timing itself."""


def _count(call: Call) -> tuple[int, float]:
    """Return the number of calls that makes one timing long enough, and the seconds of one call."""
    call()
    count = 1
    while True:
        seconds = _seconds(call, count)
        if seconds * count >= _LEAST_SECONDS or count == _MAX_CALLS:
            return count, seconds
        # Half of what this timing suggests: it may be slow by chance.
        room = int(_LEAST_SECONDS / max(seconds, 1e-7 / count) / 2)
        count = min(_MAX_CALLS, max(2 * count, room))


def _seconds(call: Call, count: int) -> float:
    now, _ = choose_clock()
    calls = repeat(None, count)
    start = now()
    for _ in calls:
        call()
    return (now() - start) / count / 1e9
