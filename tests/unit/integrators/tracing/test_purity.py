"""What a trace reached is named where it is not pure, and nothing is where all of it is."""

import sys
import types
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.helpers.programs import impure_maps, pure_maps
from verify.integrators.tracing import purity
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Tape


def impure(function: Callable[..., Any]) -> list[str]:
    tape = Tape()
    copy_function(function, tape)(tape.symbol("p"), tape.symbol("q"))
    return tape.surroundings.texts


@pytest.mark.parametrize("name", impure_maps.BY_NAME)
def test_what_is_more_than_a_function_of_its_arguments_says_why(name: str) -> None:
    function, why = impure_maps.BY_NAME[name]
    assert impure(function) == why.split("; ")


@pytest.mark.parametrize("function", pure_maps.MAPS)
def test_of_a_function_of_its_arguments_nothing_is_said(function: Callable[..., Any]) -> None:
    assert impure(function) == []


def test_nothing_of_the_users_is_changed_by_a_trace() -> None:
    counter = impure_maps.Counter()
    before = list(impure_maps.COUNT), dict(impure_maps.TABLE), impure_maps.CALLS, counter.n
    for function, _ in impure_maps.BY_NAME.values():
        impure(function)
    impure(counter)
    after = list(impure_maps.COUNT), dict(impure_maps.TABLE), impure_maps.CALLS, counter.n
    assert before == after
    assert not impure_maps.ARRAY.any()
    assert (
        impure_maps.Counter.made == len(impure_maps.Counter.table) == impure_maps.Vector.made == 0
    )
    assert not hasattr(impure_maps.math, "counter")
    assert not hasattr(sys, "x")


def test_copies_are_of_one_world() -> None:
    """What one function writes another one reads, as it is with the user's own."""
    table: list[Any] = []

    def write(x: Any) -> None:
        table.append(x)

    def step(p: Any, q: Any) -> Any:
        write(p)
        return table[-1], q + len(table)

    tape = Tape()
    p, q = tape.symbol("p"), tape.symbol("q")
    assert copy_function(step, tape)(p, q)[0] is p
    assert tape.surroundings.texts == ["table is changed"]
    assert table == []


def test_what_has_changed_back_when_the_call_is_over_is_no_state() -> None:
    turns = [1, 2, 3]

    def step(p: Any, q: Any) -> Any:
        turns.reverse()
        p = p * turns[0]
        turns.reverse()
        return p, q

    assert impure(step) == []


def test_a_state_that_comes_back_after_several_calls_is_seen_after_one() -> None:
    turns = [1, 2, 3]

    def step(p: Any, q: Any) -> Any:
        turns.append(turns.pop(0))
        return p * turns[0], q

    assert impure(step) == ["turns is changed"]


def test_a_function_that_two_modules_have_is_named_by_the_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """scipy.special has numpy's sinc, which is replaced in a trace by its name."""
    special = types.ModuleType("scipy.special")
    special.sinc = np.sinc  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "scipy.special", special)
    monkeypatch.setattr(purity, "_pure_in", purity._pure_in.__wrapped__)  # without its cache
    assert purity.pure_objects()[id(np.sinc)][0] == "numpy.sinc"
