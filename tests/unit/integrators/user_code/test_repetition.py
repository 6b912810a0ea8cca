"""Steps that remember, or are coarse: never proved, and undecided where calls differ."""

import math
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.helpers.programs import impure_maps, pure_maps, user_steps
from tests.helpers.programs import remembering_steps as steps
from tests.helpers.programs.judged import judged
from verify.integrators.results import Claims
from verify.integrators.user_code.repetition import changed_names, read_kept_state


@pytest.mark.parametrize("period", [2, 37, 100, 500])
def test_the_same_arguments_with_two_results_are_no_map(period: int) -> None:
    for step in (steps.spoiling(period), steps.by_a_method(period)):
        found = judged(step)
        assert (found.verdict, found.faults) == ("UNDECIDED", ("not a function",))
        assert " and then (" in found.reason
        assert " at p = " in found.reason


def test_so_is_a_cache_that_forgets() -> None:
    steps.NEARBY.clear()
    found = judged(steps.kept_for_a_while)
    assert (found.verdict, found.faults) == ("UNDECIDED", ("not a function",))


def test_what_raises_at_times_is_not_decided() -> None:
    found = judged(steps.raising_at_times, Claims(order=1))
    assert (found.verdict, found.faults) == ("UNDECIDED", ("fails", "keeps a state"))
    assert "OSError: busy at one call and not at another" in found.reason


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("step", "name"),
    [
        (steps.spoiling(10**7), "CALLS"),
        (steps.by_a_method(10**7), "step"),
        (steps.counted, "its attributes"),
        (steps.counted_in_a_default, "its defaults"),
        (steps.numbered, "NUMBERS"),
        (steps.generated, "TURNS"),
        (steps.turning, "TURN"),
        (steps.drawing, "random"),
        (steps.kept_exactly, "EXACTLY"),
    ],
)
def test_what_keeps_a_state_is_measured_and_not_proved(step: Any, name: str) -> None:
    found = judged(step, Claims(order=1, area_preserving=True))
    assert (found.verdict, found.faults) == ("MEASURED", ("keeps a state",))
    (note,) = (n for n in found.notes if n.startswith("it keeps a state"))
    assert name in note.rpartition(": ")[2].split(", ")


COARSE = [
    steps.kept_nearby,
    steps.rounding,
    steps.single,
    steps.single_throughout,
    steps.single_by_a_coefficient,
]


@pytest.mark.left_to_ci
@pytest.mark.sample(6)
@pytest.mark.parametrize("step", COARSE)
@pytest.mark.parametrize(
    "claims",
    [Claims(), Claims(order=2), Claims(order=1), Claims(area_preserving=True)],
    ids=["none", "right", "less", "area"],
)
def test_coarse_numbers_are_no_order(step: Any, claims: Claims) -> None:
    steps.NEARBY.clear()
    found = judged(step, claims)
    assert found.verdict == "UNDECIDED"
    assert "coarse" in found.faults
    assert any("single precision" in note for note in found.notes)


@pytest.mark.parametrize("step", [steps.cached, steps.of_an_object, steps.by_kicks])
def test_the_same_shape_without_the_fault_is_proved(step: Any) -> None:
    found = judged(step, Claims(order=2, area_preserving=True))
    assert (found.verdict, found.faults) == ("PROVED", ())


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("digits", [4, 6, 8, 10, 12, 14])
def test_a_loop_with_a_tolerance_is_not_coarse(digits: int) -> None:
    assert judged(user_steps.midpoint_to(10.0**-digits)).faults == ()


def test_an_error_that_floats_alone_see_is_no_part_of_a_proof() -> None:
    found = judged(steps.unlike_symbols)
    assert found.verdict != "PROVED"
    assert found.how == "floats"


def test_what_is_kept_is_known_by_name() -> None:
    before = read_kept_state(steps.turning)
    assert changed_names(before, read_kept_state(steps.turning)) == []
    steps.turning(0.1, 0.2, 0.1)
    assert changed_names(before, read_kept_state(steps.turning)) == ["TURN"]


# -- what a function keeps ----------------------------------------------------------------------


@pytest.fixture(autouse=True)
def _as_it_was() -> Iterator[None]:
    yield
    for module, name in ((math, "counter"), (sys, "x")):
        if hasattr(module, name):
            delattr(module, name)
    impure_maps.COUNT[:], impure_maps.Counter.made, impure_maps.CALLS = [0], 0, 0
    impure_maps.Counter.table.clear()
    impure_maps.ARRAY[:] = 0


SEEN: list[tuple[Callable[..., Any], str]] = [
    (impure_maps.in_a_list, "COUNT"),
    (impure_maps.in_an_array, "ARRAY"),
    (impure_maps.in_a_global, "CALLS"),
    (impure_maps.in_a_local_of_the_thread, "STATE"),
    (impure_maps.in_math, "math"),
    (impure_maps.in_math_imported_here, "math"),
    (impure_maps.in_sys, "sys"),
    (impure_maps.by_chance, "random"),
    (impure_maps.by_the_next_number, "NUMBERS"),
    (impure_maps.in_a_default, "its defaults"),
    (impure_maps.in_an_attribute, "its attributes"),
    (impure_maps.in_a_cell, "n"),
]


@pytest.mark.parametrize(("function", "name"), SEEN)
def test_a_call_is_seen_to_leave_something(function: Callable[..., Any], name: str) -> None:
    before = read_kept_state(function)
    assert changed_names(before, read_kept_state(function)) == []
    function(0.5, 0.25)
    assert name in changed_names(before, read_kept_state(function))


@pytest.mark.parametrize("function", pure_maps.MAPS)
def test_a_function_of_its_arguments_leaves_nothing(function: Callable[..., Any]) -> None:
    function(0.5, 0.25)
    before = read_kept_state(function)
    function(0.25, 0.5)
    assert changed_names(before, read_kept_state(function)) == []
