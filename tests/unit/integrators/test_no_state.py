"""Calls that return no state, never end or are not deterministic: told, and nothing is refuted."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import verify
from tests.helpers.programs import user_steps as own_steps
from tests.helpers.programs.judged import judged
from verify.errors import InputError
from verify.integrators.results import Claims, Finding

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
Function = Callable[..., Any]


def of_step(function: Function, seconds: float = 20) -> Finding:
    return judged(function, Claims(order=2), seconds)


def of_step_in_degrees(function: Function, seconds: float = 20) -> Finding:
    return judged(function, Claims(order=2), seconds, HENON)


def of_map(function: Function, seconds: float = 20) -> Finding:
    return verify.check_map(lambda p, q: function(p, q, 0.0), time_limit=seconds)


EACH = pytest.mark.parametrize("checked", [of_step, of_step_in_degrees, of_map])


@pytest.mark.parametrize(
    ("checked", "function", "said"),
    [
        (of_step, own_steps.not_a_number, "it returns what is not finite (nan, "),
        (of_step, own_steps.raising, "raises ValueError: no luck at p ="),
        (of_step, own_steps.nothing, "it returns None; wanted: p', q'"),
        (of_step, own_steps.texts, "it returns text; wanted: p', q'"),
        (of_step, own_steps.three, "it returns 3 numbers; wanted: p', q'"),
        (of_step, own_steps.quitting, "it calls sys.exit, or os._exit"),
        (of_step, own_steps.leaving, "it calls sys.exit, or os._exit"),
        (of_step_in_degrees, lambda p, q, h: p,
         "it returns 2 numbers, in arrays of shape (2,); wanted: p', q', arrays"),
        (of_step_in_degrees, lambda p, q, h: 1 / 0, "division by zero"),
        (of_step_in_degrees, lambda p, q, h: 1 / 0,
         " at p1 = 0.2, p2 = 0.833333, q1 = 1.16667, q2 = 0.75, h = 0.0"),
        (of_step_in_degrees, lambda p, q, h: None, "it returns None; wanted: p', q'"),
        (of_step_in_degrees, lambda p, q, h: (p + np.nan, q),
         "it returns what is not finite (nan, nan, "),
        (of_map, lambda p, q, h: p, "it returns 1 number; wanted: p', q'"),
        (of_map, lambda p, q, h: None, "it returns None"),
        (of_map, lambda p, q, h: (p, "q"), "it returns text"),
        (of_map, lambda p, q, h: (p, math.nan), "not finite"),
        (of_map, lambda p, q, h: 1 / 0, "division by zero"),
        (of_map, lambda p, q, h: (p, 1j), "complex"),
    ],
)  # fmt: skip
def test_a_call_that_returns_no_state_is_an_error_and_refutes_nothing(
    checked: Callable[..., Finding], function: Function, said: str
) -> None:
    with pytest.raises(InputError) as error:
        checked(function)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@EACH
def test_what_is_not_deterministic_is_undecided(checked: Callable[..., Finding]) -> None:
    found = checked(lambda p, q, h: (p + np.random.default_rng().normal(), q))
    assert (found.verdict, found.how, found.faults) == ("UNDECIDED", "calls", ("not a function",))
    assert "not deterministic" in found.reason


@EACH
def test_an_endless_call_is_ended(checked: Callable[..., Finding]) -> None:
    with pytest.raises(InputError, match="does not end within"):
        checked(own_steps.endless, 0.3)
