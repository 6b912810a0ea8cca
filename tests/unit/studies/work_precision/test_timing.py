"""Run times by a clock that the test moves itself: interleaved, repeated, the blank subtracted."""

import gc
from collections.abc import Callable

import pytest

from verify.studies.work_precision import timing
from verify.studies.work_precision.timing import (
    RunTime,
    subtract_blank,
    subtract_or_none,
    time_interleaved,
)


class Clock:
    """A clock that calls advance; `slow` is what the whole machine loses at a moment."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 0
        self.seen: list[str] = []
        monkeypatch.setattr(timing, "choose_clock", lambda: (lambda: self.now, "by hand"))

    def call(self, name: str, *takes: int) -> Callable[[], None]:
        """Takes so many nanoseconds, the last of them again and again."""
        left = list(takes)

        def made() -> None:
            self.seen.append(name)
            self.now += left.pop(0) if len(left) > 1 else left[0]

        return made


LONG = 50_000_000  # ns, so that one call is one timing


def test_every_call_is_timed_in_each_round_before_any_is_timed_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock(monkeypatch)
    found = time_interleaved([clock.call("a", LONG), clock.call("b", 2 * LONG)], 3)
    assert found == [RunTime(0.05, 0.05), RunTime(0.1, 0.1)]
    assert "".join(clock.seen) == "aabb" + "ba" + "ab", "each begins with a warm-up"


def test_a_slow_first_call_is_the_warm_up_and_a_slow_round_moves_no_median(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock(monkeypatch)
    # The warm-up, and five rounds of which one is slow.
    call = clock.call("a", 100 * LONG, LONG, LONG, 9 * LONG, LONG, LONG)
    assert time_interleaved([call], 5) == [RunTime(0.05, 0.05)]


def test_a_short_call_is_repeated_until_its_timing_is_long_enough(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock(monkeypatch)
    (found,) = time_interleaved([clock.call("a", 1000)], 1)
    assert found == RunTime(1e-6, 1e-6)
    shorter = timing._LEAST_SECONDS / 4  # those before, which were too short
    assert 1e-6 * len(clock.seen) >= timing._LEAST_SECONDS + shorter
    resolution = timing._COARSEST_RESOLUTION
    assert 1000 * resolution <= timing._LEAST_SECONDS, "well above the timer's resolution"


def test_what_a_blank_call_takes_is_subtracted_and_nothing_becomes_negative() -> None:
    assert subtract_blank(RunTime(5e-6, 6e-6), RunTime(1e-6, 2e-6)) == RunTime(
        pytest.approx(4e-6), pytest.approx(5e-6)
    )
    gone = subtract_blank(RunTime(1e-6, 1e-6), RunTime(2e-6, 2e-6))
    assert 0 < gone.least <= gone.median


def test_the_collector_is_as_it_was_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(monkeypatch)
    collecting = []
    time_interleaved([clock.call("a", LONG), lambda: collecting.append(gc.isenabled())], 1)
    assert gc.isenabled()
    assert not collecting[-1]


def test_the_real_clock_moves() -> None:
    now, name = timing.choose_clock()
    begun = now()
    sum(range(200_000))
    assert now() > begun
    assert name


def test_a_run_that_is_shorter_than_its_call_has_no_time() -> None:
    blank = RunTime(100e-9, 110e-9)
    assert subtract_or_none(RunTime(150e-9, 190e-9), blank) is None
    assert subtract_or_none(RunTime(150e-9, 250e-9), blank) == subtract_blank(
        RunTime(150e-9, 250e-9), blank
    )
