"""Which mistake a wrong clock is said to be, of traced steps and of measured ones."""

import math
from collections.abc import Callable
from typing import Any

import pytest

import verify
from tests.helpers.programs.blind import blind
from tests.unit.integrators.test_in_time import (
    DRIVEN,
    euler,
    four_stages_of_yoshida,
    rk4_at,
    verlet_at,
)
from verify.integrators.results import Finding

FORCED = "p**2/2 + q**2/2 + q**4/4 - q*cos(7*t/5)/2"
Step = Callable[..., Any]


def force(q: Any, t: Any) -> Any:
    return -q - q**3 + math.cos(7 * t / 5) / 2


def forced_verlet(first: float, last: float) -> Step:
    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p + h / 2 * force(q, t + first * h)
        q = q + h * p
        return p + h / 2 * force(q, t + last * h), q

    return step


def forced_yoshida(p: Any, q: Any, t: Any, h: Any) -> Any:
    """Each kick reads what the kicks before it add up to."""
    w, kicks = 1 / (2 - 2 ** (1 / 3)), 0.0
    for size in (w, 1 - 2 * w, w):
        p = p + size * h / 2 * force(q, t + kicks * h)
        q = q + size * h * p
        kicks += size / 2
        p = p + size * h / 2 * force(q, t + kicks * h)
        kicks += size / 2
    return p, q


def drifting(first: float, last: float) -> Step:
    """For a mass that depends on time: p²(1 + sin(t)/3)/2."""

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        q = q + h / 2 * p * (1 + math.sin(t + first * h) / 3)
        p = p - h * q
        return p, q + h / 2 * p * (1 + math.sin(t + last * h) / 3)

    return step


HEAVIER = "p**2*(1 + sin(t)/3)/2 + q**2/2"
EXCHANGED = "clock of its own kind: kick and drift exchanged"
NAMED: dict[str, tuple[str, Step, int, str, str]] = {
    "kicks on the kicks' clock": (FORCED, forced_verlet(0, 0.5), 2, EXCHANGED, "t + h/4"),
    "a factor of time": (DRIVEN, verlet_at(0, 0.5), 2, EXCHANGED, "t + h/4"),
    "the same, after it": (
        DRIVEN, verlet_at(0.5, 1), 2, "own kind, after it: kick and drift exchanged", "t + 3h/4"),
    "Yoshida's": (FORCED, forced_yoshida, 4, EXCHANGED, "about t -1.137 h"),
    "drifts on the drifts' clock": (HEAVIER, drifting(0, 0.5), 2, EXCHANGED, "t + h/4"),
    "the end at the middle": (
        DRIVEN, rk4_at(1, 1), 4, "in the step's middle is read at its end", "t + 5h/6"),
    "the middle at the end": (
        DRIVEN, rk4_at(0.5, 0.5), 4, "t + h in place of t + h/2", "t + 5h/12"),
    "slow": (DRIVEN, four_stages_of_yoshida(0.5), 4, "t + h/2 in place of t + h/4", "t + h/4"),
    "frozen": (DRIVEN, four_stages_of_yoshida(0), 4, "read at t in every stage", ""),
}  # fmt: skip
RIGHT: dict[str, tuple[str, Step, int]] = {
    "kick first": (FORCED, forced_verlet(0, 1), 2),
    "of order 1": (DRIVEN, euler, 1),
    "drift first": (HEAVIER, drifting(0, 1), 2),
    "four stages": (DRIVEN, rk4_at(0.5, 1), 4),
}


def notes(system: str, step: Step, **claims: Any) -> tuple[Finding, str]:
    found = verify.check(system, step, **claims)
    assert isinstance(found, Finding)
    return found, "\n".join(map(str, found.notes))


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", NAMED)
def test_a_traced_step_is_told_what_its_clock_does_and_what_it_is_without(name: str) -> None:
    system, step, order, words, _ = NAMED[name]
    found, said = notes(system, step, order=order)
    assert (found.verdict.value, found.convergence_order) == ("REFUTED", 1)
    assert words in said
    assert f"is of order {order} " in said


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", [name for name in NAMED if NAMED[name][-1]])
def test_a_measured_one_is_told_at_which_time_it_reads_in_the_mean(name: str) -> None:
    system, step, _, _, mean = NAMED[name]

    def compares(p: Any, q: Any, t: Any, h: Any) -> Any:
        return step(p, q, t, h) if q < 1e9 else (p, q)

    for how, made in (("duals", compares), ("floats", blind(step))):
        found, said = notes(system, made)
        assert (found.how, found.convergence_order) == (how, 1)
        assert f"H is read at {mean} in the mean" in said


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", RIGHT)
def test_of_a_right_clock_nothing_is_said(name: str) -> None:
    system, step, order = RIGHT[name]
    for made in (step, blind(step)):
        found, said = notes(system, made)
        assert found.convergence_order == order
        assert "read at" not in said


def test_of_another_mistake_nothing_is_said_of_the_clock() -> None:
    """Of order 1, and wrong where time has no part in it."""

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p + h / 3 * force(q, t)
        q = q + h * p
        return p + h * 2 / 3 * force(q, t + h), q

    for made in (step, blind(step)):
        found, said = notes(FORCED, made)
        assert found.convergence_order == 1
        assert "read at" not in said


def test_a_reading_that_cannot_be_told_apart_is_left_unnamed() -> None:
    """Two times in one factor; and one that is made of both parts of a kick."""

    def two(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p - h * q * (math.sin(t) + math.sin(t + h))
        return p, q + h * p

    def mixed(p: Any, q: Any, t: Any, h: Any) -> Any:
        q = q + h / 2 * p
        p = p - h * (q + q**3) + h / 2 * math.cos(7 * (t + h) / 5)
        return p, q + h / 2 * p

    for system, step in (("p**2/2 + q**2*sin(t)", two), (FORCED, mixed)):
        found, said = notes(system, step)
        assert found.convergence_order is not None
        assert "in place of" not in said
