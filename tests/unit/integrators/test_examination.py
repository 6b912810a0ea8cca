"""Steps that are proved by a trace of them, and steps whose code does not let one be trusted."""

import math
from contextlib import suppress
from typing import Any

import numpy as np
import pytest

from tests.helpers.programs import user_steps
from tests.helpers.programs.judged import judged
from verify.algebra.formula import parse
from verify.hamiltonians import systems
from verify.integrators.results import Claims
from verify.proof.order_for_one_h import prove
from verify.schemes import get


def test_a_branch_that_hides_from_symbols_is_seen() -> None:
    """`except` swallows what a symbol cannot do, so that a trace alone would be of another map."""

    def step(p: Any, q: Any, h: Any) -> Any:
        try:
            large = bool(q > -10)
        except TypeError:
            large = False
        p = p - h * math.sin(q) * (1 if large else 2)
        return p, q + h * p

    found = judged(step, Claims(order=1))
    assert (found.verdict, found.how) == ("MEASURED", "duals")
    assert "catches the error of a symbol" in found.notes[0]


@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_a_mistake_in_any_quadrant_is_seen(signs: tuple[int, int]) -> None:
    """Code that compares numbers is measured where it is tried, which is in all four."""

    def step(p: Any, q: Any, h: Any) -> Any:
        wrong = p * signs[0] > 0 and q * signs[1] > 0
        return user_steps.euler_a(p * (1 + h / 1000 if wrong else 1), q, h)

    found = judged(step, Claims(order=1, area_preserving=True))
    assert (found.verdict, found.how) == ("REFUTED", "duals")


def test_a_caught_error_hides_no_branch_that_no_point_reaches() -> None:
    """Floats at the points that are tried agree with such a trace, and it is no proof."""

    def compares(p: Any, q: Any, h: Any) -> Any:
        with suppress(TypeError):
            p = 2 * p if q > 100 else p
        return user_steps.euler_a(p, q, h)

    def rounds(p: Any, q: Any, h: Any) -> Any:
        try:
            turns = round(q / 1000)
        except TypeError:
            turns = 0
        return user_steps.euler_a(p * (1 + turns), q, h)

    for step in (compares, rounds):
        assert judged(step, Claims(order=1)).verdict == "MEASURED"


def test_what_asks_whether_h_is_positive_is_proved_for_such_h() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        if not h > 0:
            raise ValueError("h")
        return user_steps.verlet(p, q, h)

    found = judged(step)
    assert found.verdict == "PROVED"
    assert "h > 0 is taken for granted" in found.notes


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("name", ["duffing", "pendulum", "morse", "toda", "lennard-jones", "twist"])
@pytest.mark.parametrize("scheme", ["euler", "rk4", "explicit-midpoint"])
def test_a_traced_scheme_is_proved_as_the_scheme_itself_is(name: str, scheme: str) -> None:
    system = systems.get(name)
    hamiltonian = system.hamiltonian(dict.fromkeys(system.parameters, "3/2"))
    gradient = hamiltonian.gradient()

    def slope(z: Any) -> Any:
        h_p, h_q = gradient(*z)
        return np.array([-h_q, h_p])

    def step(p: Any, q: Any, h: Any) -> Any:
        z = np.array([p, q])
        a = slope(z)
        b = slope(z + h / 2 * a)
        if scheme == "euler":
            return z + h * a
        if scheme == "explicit-midpoint":
            return z + h * b
        c = slope(z + h / 2 * b)
        return z + h / 6 * (a + 2 * b + 2 * c + slope(z + h * c))

    found = judged(step, hamiltonian=hamiltonian)
    known = prove(get(scheme).step_map(hamiltonian))
    assert (found.how, found.verdict) == ("proof", known.verdict), found.notes
    assert (found.order, found.convergence_order) == (known.order, known.convergence_order)
    assert parse(found.leading or "") == parse(known.first.text)
