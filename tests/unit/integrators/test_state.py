"""Steps and maps that keep a state, or read what may change: never proved, and it is named."""

import math
import threading
import time
from typing import Any

import pytest

import verify
from tests.helpers.programs.judged import judged
from verify.integrators.results import Claims

CALLS = [0]
THERE = threading.local()
BEGUN = time.time()


def turn(p: Any, q: Any) -> Any:
    p = p - math.sin(q) / 10
    return p, q + p / 10


def counted(p: Any, q: Any) -> Any:
    CALLS[0] += 1
    p, q = turn(p, q)
    return (1.001 * p if CALLS[0] % 10**7 == 0 else p), q


def counted_in_a_thread(p: Any, q: Any) -> Any:
    THERE.calls = getattr(THERE, "calls", 0) + 1
    p, q = turn(p, q)
    return p * (1 + (THERE.calls > 10**7)), q


def counted_in_math(p: Any, q: Any) -> Any:
    math.calls = getattr(math, "calls", 0) + 1  # type: ignore[attr-defined]
    return turn(p, q)


def by_the_clock(p: Any, q: Any) -> Any:
    p, q = turn(p, q)
    return (2 * p if time.time() - BEGUN > 10**6 else p), q


CHANGING = {
    counted: "CALLS", counted_in_a_thread: "THERE", counted_in_math: "math.calls",
    by_the_clock: "time.time",
}  # fmt: skip


@pytest.mark.parametrize("function", CHANGING, ids=lambda f: f.__name__)
def test_a_map_that_may_change_is_measured_and_what_it_reads_is_named(function: Any) -> None:
    found = verify.check_map(function)
    assert found.verdict == "MEASURED"
    assert any(CHANGING[function] in note for note in found.notes), found.notes


@pytest.mark.parametrize("function", CHANGING, ids=lambda f: f.__name__)
def test_so_is_a_step(function: Any) -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        function(p, q)
        p = p - h * math.sin(q)
        return p, q + h * p

    found = judged(step, Claims(order=1, symplectic=True))
    assert found.verdict == "MEASURED"
    assert any(CHANGING[function] in note for note in found.notes), found.notes


def test_the_same_without_it_is_proved() -> None:
    assert verify.check_map(turn).verdict == "PROVED"


def test_a_state_that_shows_is_no_map() -> None:
    calls = [0]

    def spoilt(p: Any, q: Any) -> Any:
        calls[0] += 1
        return (1.001 * p if calls[0] % 20 == 0 else p), q

    found = verify.check_map(spoilt)
    assert (found.verdict, found.faults) == ("UNDECIDED", ("not a function",))


def test_a_state_that_begins_anew_in_each_process_is_seen_there() -> None:
    """Ten calls are alike in every order of one process, and the eleventh is not."""
    calls = [0]

    def first_ten(p: Any, q: Any) -> Any:
        calls[0] += 1
        return p * (1 + 1e-9 * min(calls[0], 1)), q

    assert verify.check_map(first_ten).verdict != "PROVED"
