"""What is drawn shrinks to what can be read."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import shrunk
from tests.unit.strategies.test_strategies import P, Q, mixed
from verify import Hamiltonian
from verify import strategies as s
from verify.scenes.values import InitialValue

OSCILLATORS = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2"


def uses(function: Any) -> Callable[[Hamiltonian], bool]:
    return lambda h: bool(h.exact.has(function))


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("strategy", "holds", "simplest"),
    [
        (s.hamiltonians(), lambda _: True, "p**2/2 + q**2/2"),
        (s.hamiltonians(bounded=False), lambda _: True, "p**2/2 - q**2/2"),
        (s.hamiltonians(separable=False, bounded=False), lambda _: True, "p*q"),
        (s.hamiltonians(degree=1), lambda _: True, "p/2"),
        (s.hamiltonians(["trigonometric"]), lambda _: True, "p**2/2 + cos(q)"),
        (s.hamiltonians(["rational"]), lambda _: True, "p**2/2 + 1/(q**2 + 1)"),
        (s.hamiltonians(), uses(sympy.cos), "p**2/2 + cos(q)"),
        (s.hamiltonians(), mixed, "p**2/2 + p*q/2 + q**2/2"),
        (s.hamiltonians(["polynomial"]), lambda h: h.exact.diff(Q, 3) != 0, "p**2/2 + q**4/2"),
        (s.hamiltonians(bounded=True), lambda h: h.exact.coeff(P**2) > 3, "4*p**2 + q**2/2"),
        (s.hamiltonians(degrees=2), lambda _: True, OSCILLATORS),
        (
            s.hamiltonians(degrees=2, coupled=True),
            lambda _: True,
            "p1**2/2 + p2**2/2 + q1**2/2 + q1*q2 + q2**2/2",
        ),
    ],
)
def test_a_hamiltonian_shrinks_to_what_can_be_read(
    strategy: st.SearchStrategy[Hamiltonian], holds: Callable[[Any], bool], simplest: str
) -> None:
    assert shrunk(strategy, holds).formula == simplest


def test_a_scene_shrinks_to_the_oscillator_and_one_step() -> None:
    found = shrunk(s.scenes(), lambda x: x.schemes == ("stormer-verlet",) and x.grid.steps > 4)
    assert found.hamiltonian == "p**2/2 + q**2/2"
    assert found.grid.steps == 5
    assert found.grid.step_sizes == (Fraction(1, 10),)
    assert found.grid.initial_values == (InitialValue(q=0, p=0),)


@pytest.mark.left_to_ci
def test_a_scene_in_two_degrees_shrinks_to_oscillators_and_the_first_scheme() -> None:
    scene = shrunk(s.scenes(degrees=2))
    assert scene.exact_hamiltonian().formula == OSCILLATORS
    assert scene.schemes == ("lie1",)
