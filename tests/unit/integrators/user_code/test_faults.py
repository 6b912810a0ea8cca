"""Faults of a user's code: they are named, and a second process shows what is no function."""

import atexit
import itertools
import os
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.helpers.programs import user_steps
from tests.helpers.programs.judged import judged
from verify.integrators.user_code.faults import outcome, outcomes_elsewhere


@pytest.mark.parametrize(
    ("function", "verdict", "fault", "said"),
    [
        (user_steps.frozen, "REFUTED", "frozen", "preserves area and is no scheme"),
        (user_steps.without_h, "REFUTED", "ignores h", "it ignores h"),
        (user_steps.drawn, "UNDECIDED", "not a function", "not deterministic"),
        (user_steps.counting, "UNDECIDED", "not a function", "not deterministic"),
    ],
)
def test_what_is_wrong_is_named(
    function: Callable[..., Any], verdict: str, fault: str, said: str
) -> None:
    found = judged(function)
    assert (found.verdict, found.how, found.faults) == (verdict, "calls", (fault,))
    assert said in found.reason


def test_a_state_that_shows_after_many_calls_is_found_at_the_end() -> None:
    calls = [0]

    def step(p: Any, q: Any, h: Any) -> Any:
        calls[0] += 1
        p, q = user_steps.branching(p, q, h)
        return p + (1e-9 if calls[0] > 40 else 0), q

    assert judged(step).faults == ("not a function",)


def test_changed_arrays_are_named_and_nothing_is_refuted() -> None:
    found = judged(user_steps.in_place)
    assert (found.verdict, found.faults) == ("PROVED", ("mutates",))
    assert "changes the arrays" in " ".join(found.notes)
    assert judged(user_steps.euler_a).faults == ()


def test_what_it_prints_does_not_reach_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    assert judged(user_steps.printing).verdict == "PROVED"
    out, err = capsys.readouterr()
    assert out == ""
    assert "a step" in err


# -- in a second process ------------------------------------------------------------------------

State = tuple[float, float]
STATES: list[State] = [(0.1 * k, 1.0) for k in range(5)]
LOCAL, MODULE = threading.local(), SimpleNamespace()


def right(state: State) -> State:
    return state[0] / 3, state[1]


def counting_in_the_thread(state: State) -> State:
    LOCAL.n = getattr(LOCAL, "n", 0) + 1
    return state[0] + (LOCAL.n == 3), state[1]


def counting_in_a_module(state: State) -> State:
    MODULE.n = getattr(MODULE, "n", 0) + 1
    return state[0] + (MODULE.n == 3), state[1]


def by_the_clock(state: State) -> State:
    return state[0], time.monotonic()


def by_a_slow_clock(state: State) -> State:
    return state[0] + (time.time() - 1e15 > 0), state[1]


def by_the_process(state: State) -> State:
    return state[0], float(os.getpid())


def raising(state: State) -> State:
    raise OSError("busy")


def agree(call: Callable[[State], Any]) -> bool:
    here = [outcome(call, state) for state in STATES]
    return here == outcomes_elsewhere(call, STATES, 20)


@pytest.mark.parametrize(
    "call", [counting_in_the_thread, counting_in_a_module, by_the_clock, by_the_process]
)
def test_what_is_no_function_is_seen(call: Callable[[State], State]) -> None:
    assert not agree(call)


@pytest.mark.parametrize("call", [right, raising, by_a_slow_clock])
def test_what_is_one_in_these_calls_is_seen_to_be(call: Callable[[State], State]) -> None:
    """A clock that changes nothing for an hour is not seen."""
    assert agree(call)


def test_all_digits_are_told() -> None:
    (text,) = outcomes_elsewhere(lambda _: (0.1, [np.float32(0.1), 2]), [0], 20)
    assert text == f"({(0.1).hex()}, ({float(np.float32(0.1)).hex()}, 2))"
    (text,) = outcomes_elsewhere(lambda _: np.array([[0.1], [1.0]]), [0], 20)
    assert text == f"(({(0.1).hex()}), ({(1.0).hex()}))"
    assert outcome(lambda _: object(), 0) == "object"


def test_states_are_in_the_order_in_which_they_were_asked() -> None:
    numbers = itertools.count()
    assert outcomes_elsewhere(lambda k: (k, next(numbers)), [10, 11, 12], 20) == [
        "(10, 2)",
        "(11, 1)",
        "(12, 0)",
    ]
    assert next(numbers) == 0  # this process's own is not touched


def test_one_that_leaves_or_hangs_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    children, fork = list[int](), os.fork

    def forked() -> int:
        children.append(fork())
        return children[-1]

    monkeypatch.setattr(os, "fork", forked)

    def leaving(k: int) -> int:
        if k == 1:
            os._exit(7)
        return k

    def hanging(k: int) -> int:
        while k == 1:
            pass
        return k

    assert outcomes_elsewhere(leaving, [0, 1, 2], 20) == [None, None, "2"]
    begun = time.monotonic()
    assert outcomes_elsewhere(hanging, [0, 1, 2], 0.5) == [None, None, "2"]
    assert time.monotonic() - begun < 10
    assert len(children) == 2
    for child in children:
        with pytest.raises(ChildProcessError):
            os.waitpid(child, os.WNOHANG)


def test_what_quits_raises() -> None:
    assert outcomes_elsewhere(lambda _: sys.exit(3), [0], 20) == ["SystemExit"]


def test_what_it_starts_ends_with_it(tmp_path: Path) -> None:
    shown = tmp_path / "pid"

    def starting(k: int) -> int:
        shown.write_text(str(subprocess.Popen(["sleep", "60"]).pid))
        return k

    assert outcomes_elsewhere(starting, [0], 20) == ["0"]
    pid = int(shown.read_text())
    for _ in range(100):
        if not Path(f"/proc/{pid}").exists() or " Z " in Path(f"/proc/{pid}/stat").read_text():
            return
        time.sleep(0.05)
    pytest.fail("it goes on")


def test_it_shows_nothing_and_ends_quietly(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    ended = tmp_path / "ended"
    atexit.register(ended.touch)

    def printing(k: int) -> int:
        print("a step", flush=True)
        print("a step", file=sys.__stdout__, flush=True)
        os.write(2, b"a step")
        atexit.register(ended.touch)
        return k

    print("before", end="")
    try:
        assert outcomes_elsewhere(printing, [0], 20) == ["0"]
    finally:
        atexit.unregister(ended.touch)
    assert capfd.readouterr() == ("before", "")
    assert not ended.exists()


def test_many_long_outcomes_go_through() -> None:
    long = [random.Random(k).random() for k in range(20_000)]  # noqa: S311
    assert outcomes_elsewhere(lambda _: long, range(3), 60) == [outcome(lambda _: long, 0)] * 3
