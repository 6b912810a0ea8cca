"""Where a trace reads a time: when it does, when it is due, and what part of the step it is."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.clocks import find_misreadings
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.readings import NoReadingsError, Readings
from verify.integrators.tracing.trace import Node, Tape

FORCED = Hamiltonian.parse("p**2/2 + q**2/2 - q*cos(7*t/5)/2")
HALF = Fraction(1, 2)


def traced(step: Callable[..., Any]) -> tuple[Node, Node]:
    tape = Tape()
    p, q, t, h = (tape.symbol(name) for name in "pqth")
    x, y = copy_function(step, tape)(p, q, t, h)
    return x.node, y.node


def verlet(p: Any, q: Any, t: Any, h: Any) -> Any:
    p = p + h / 2 * (math.cos(7 * t / 5) / 2 - q)
    q = q + h * p
    return p + h / 2 * (math.cos(7 * (t + h / 4) / 5) / 2 - q), q


def midpoint(p: Any, q: Any, t: Any, h: Any) -> Any:
    x, y = p + h / 2 * (math.cos(7 * t / 5) / 2 - q), q + h / 2 * p
    return p + h * (math.cos(7 * (t + h) / 5) / 2 - y), q + h * x


def reads(step: Callable[..., Any]) -> list[tuple[Fraction, Fraction, Fraction]]:
    found = Readings(FORCED, *traced(step)).reads
    assert all(read.of_p for read in found)
    return [(read.time, read.due, read.size.limit_denominator(1000)) for read in found]


def test_the_kicks_of_a_splitting() -> None:
    assert reads(verlet) == [(Fraction(0), Fraction(0), HALF), (Fraction(1, 4), Fraction(1), HALF)]


def test_the_stages_of_a_runge_kutta_method() -> None:
    """The first is read for the second alone: of the step itself it is no part."""
    assert reads(midpoint) == [(Fraction(0),) * 3, (Fraction(1), HALF, Fraction(1))]


def test_a_step_is_mended_at_its_readings_and_nowhere_else() -> None:
    readings = Readings(FORCED, *traced(midpoint))
    again = Readings(FORCED, *readings.with_due_times())
    assert [read.time for read in again.reads] == [read.due for read in readings.reads]
    (said,) = find_misreadings(FORCED, *traced(midpoint), 1)
    assert "it is of order 2 with H read at t + h/2 in place of t + h" in said
    assert find_misreadings(FORCED, *readings.with_due_times(), 2) == []


def test_what_has_that_order_anyhow_is_told_nothing() -> None:
    assert find_misreadings(FORCED, *traced(midpoint), 2) == []


def test_two_times_in_one_factor_are_no_reading() -> None:
    def both(p: Any, q: Any, t: Any, h: Any) -> Any:
        return p - h * q * (math.cos(t) + math.cos(t + h)), q + h * p

    with pytest.raises(NoReadingsError):
        Readings(FORCED, *traced(both))
