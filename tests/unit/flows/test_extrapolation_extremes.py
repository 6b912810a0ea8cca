"""The exact solution at extreme initial values and times: an answer, or a clear error, and soon."""

import time as clock
from fractions import Fraction
from typing import Any

import mpmath
import pytest

from tests.unit.flows.test_solution import (
    CUBIC,
    DUFFING,
    LENNARD_JONES,
    PENDULUM,
    PI,
    near,
    solve,
)
from verify.flows.extrapolation import NoFlowError

EXTREME: dict[str, tuple[str, Any, Any, Any]] = {
    "tiny": (DUFFING, 0, "1e-300", 10),
    "tiny-for-long": (DUFFING, 0, "1e-300", 10**8),
    "huge": (DUFFING, 0, "1e150", 10),
    "for-long": (DUFFING, 0, "3/2", 10**8),
    "20000-periods": (DUFFING, 0, "3/2", 20000 * 5),
    "nearly-upside-down": (PENDULUM, 0, Fraction(PI) - Fraction(1, 10**30), 1000),
    "far-round": (PENDULUM, "5/2", "100000000.5", 10**8),
    "very-fast": (PENDULUM, "1e150", 1, 3),
    "top-for-ever": (PENDULUM, 2, 0, 10**8),
    "barely-moving": (PENDULUM, "1e-300", 0, "1e5"),
    "atoms-fly-far": ("p**2/2 + 3*(exp(q) - 1)**2", 5, 1, 10**8),
    "stiff-walls": ("p**2/2 + exp(q) + exp(-q)", 1, 40, 100),
    "to-the-barrier": ("p**2/2 + q**2/2 - q**4/2", "1/2", 0, 10**8),
    "from-both-ends": (CUBIC, 0, "-1/2", -(10**8)),
    "all-sizes": ("p**2/2 + q**2/2 + q**4/(4*10**60*10**60)", "1e1000", "1e-1000", 1),
    "all-time": (DUFFING, 1, 1, "1e1000"),
    "smallest-swing-of-all": (PENDULUM, 1, "1e-1000", "1e1000"),
    "largest-twist-of-all": ("(p**2 + q**2)**2/4", "1e1000", 1, "1e1000"),
    "fast-twist": ("(p**2 + q**2)**2/4", 10**8, 1, 10**8),
}


@pytest.mark.parametrize(("formula", "p", "q", "time"), EXTREME.values(), ids=EXTREME)
def test_extreme_inputs_have_all_their_digits_and_soon(
    formula: str, p: Any, q: Any, time: Any
) -> None:
    parameters = {"delta": 1} if "delta" in formula else {}
    began = clock.monotonic()
    found = solve(formula, p, q, time, 20, **parameters)
    finer = solve(formula, p, q, time, 60, **parameters)
    assert clock.monotonic() - began < 20
    assert abs(found.p - finer.p) <= found.bound + finer.bound
    assert abs(found.q - finer.q) <= found.bound + finer.bound
    assert found.bound * 10**20 <= max(map(abs, (found.p, found.q, Fraction(p), Fraction(q))))


def test_a_small_oscillation_is_that_of_the_linear_equation() -> None:
    found = solve(DUFFING, 0, "1e-300", 10, 30, delta=1)
    assert near(found.q * 10**300, mpmath.cos(10), 14)
    assert near(found.p * 10**300, -mpmath.sin(10), 14)


BEYOND: dict[str, tuple[str, Any, Any, Any, str]] = {
    "falls-off": ("p**2/2 - q**2/2", 1, 1, 10**8, r"beyond 2\^"),
    "falls-off-the-line": ("p**2/2 - q**2/2", 1, -1, -(10**8), r"beyond 2\^"),
    "steep-wall": ("p**2/2 + 3*(exp(q) - 1)**2", 1, 10**8, 1, "loses more than"),
    "stiff-walls": ("p**2/2 + exp(q) + exp(-q)", 1, 10**8, 1, "loses more than"),
    "out-of-reach": ("p**2/2 + exp(q) + exp(-q)", 1, "1e1000", 1, "loses more than"),
    "out-of-reach-numerically": ("p**2/2 + exp(q) - q - 1", 1, "1e1000", 1, "where H is defined"),
    "into-the-pole": (LENNARD_JONES, 1, 0, 1, "not defined"),
}


@pytest.mark.parametrize(("formula", "p", "q", "time", "said"), BEYOND.values(), ids=BEYOND)
def test_what_is_out_of_reach_says_so_soon(
    formula: str, p: Any, q: Any, time: Any, said: str
) -> None:
    began = clock.monotonic()
    with pytest.raises(NoFlowError, match=said):
        solve(formula, p, q, time)
    assert clock.monotonic() - began < 5
