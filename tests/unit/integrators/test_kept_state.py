"""What a function keeps is seen to change wherever one call of it can leave something."""

import math
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.helpers.programs import impure_maps, pure_maps
from verify.integrators.user_code.repetition import changed_names, read_kept_state


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
