"""Angles that a step reduces: compared modulo a period of the motion, and modulo nothing else."""

import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.end_to_end.test_command_line import here
from tests.helpers.programs import user_steps
from tests.helpers.programs.judged import judged as found_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.wrap_periods import periods_of
from verify.integrators.results import Claims
from verify.verdict import Verdict

Step = Callable[..., Any]
TURN = 2 * math.pi
CLAIMS = Claims(order=2, symplectic=True)
CHAIN = Hamiltonian.parse("(p1**2 + p2**2)/2 - cos(q1) - cos(q1 - q2) - cos(2*q2)")


def reduced(step: Step, turn: float = TURN, least: float = 0.0) -> Step:
    def own(p: Any, q: Any, h: Any) -> Any:
        p, q = step(p, q, h)
        return p, (q - least) % turn + least

    return own


def by_branches(p: Any, q: Any, h: Any) -> Any:
    p, q = user_steps.verlet(p, q, h)
    return p, q + TURN if q < 0 else q


def verlet(p: Any, q: Any, h: Any) -> Any:
    """Of the pendulum, in floats alone."""
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def contracting(p: Any, q: Any, h: Any) -> Any:
    p, q = verlet(p, q, h)
    return p * (1 - h**3 / 10), q


def too_weak(p: Any, q: Any, h: Any) -> Any:
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * 0.999 * math.sin(q), q


@pytest.mark.parametrize(
    "step",
    [reduced(verlet), reduced(verlet, least=-math.pi), reduced(verlet, 2 * TURN), by_branches],
)
def test_a_right_step_that_reduces_its_angle_is_measured(step: Step) -> None:
    found = found_of(step, CLAIMS)
    assert (found.verdict, found.convergence_order) == (Verdict.MEASURED, 2), found.reason
    assert found.area_preserving is True


def test_what_it_is_compared_by_is_told() -> None:
    assert "q is compared modulo 6.28319, a period of the motion" in found_of(reduced(verlet)).notes
    assert not any(
        "modulo" in note for note in found_of(reduced(verlet, 9 * TURN, -4 * TURN)).notes
    )
    assert not any("modulo" in note for note in found_of(verlet, CLAIMS).notes)


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (reduced(contracting), "det J ≡ 1 is claimed; ΔJ has order 3"),
        (reduced(too_weak), "the map agrees with the exact flow up to h^0 only"),
        (reduced(verlet, 6.28), "the map's distance from the exact flow does not vanish as h → 0"),
        (reduced(verlet, 6.2832), "does not vanish as h → 0"),
    ],
)
def test_an_error_beside_it_is_refuted(step: Step, words: str) -> None:
    found = found_of(step, CLAIMS)
    assert (found.verdict, words in found.reason) == (Verdict.REFUTED, True), found.reason
    assert "h^-1" not in found.reason


def test_a_map_that_moves_by_less_than_a_period_agrees_not_even_at_0(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.py"
    file.write_text("def step(p, q, h):\n    return p, q + h*p + 1\n")
    for formula in ("p**2/2", "(p1**2 + p2**2)/2"):
        status, out, _ = here(capsys, "check-integrator", f"{file}:step", "--hamiltonian", formula)
        assert (status, "not even at h = 0" in out, "h^-1" in out) == (1, True, False), out


def test_where_h_is_not_periodic_nothing_is_reduced() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        p = p - h / 2 * q
        q = q + h * p
        return p - h / 2 * q, q

    harmonic = Hamiltonian.parse("(p**2 + q**2)/2")
    assert found_of(step, CLAIMS, hamiltonian=harmonic).verdict is Verdict.PROVED
    assert found_of(reduced(step), CLAIMS, hamiltonian=harmonic).verdict is Verdict.REFUTED


def forces(q: Any) -> Any:
    bent = np.sin(q[0] - q[1])
    return -np.array([np.sin(q[0]) + bent, 2 * np.sin(2 * q[1]) - bent])


def of_chain(p: Any, q: Any, h: Any) -> Any:
    p = p + h / 2 * forces(q)
    q = q + h * p
    return p + h / 2 * forces(q), q


@pytest.mark.parametrize(("turn", "verdict"), [(TURN, "MEASURED"), (6.283, "REFUTED")])
def test_in_two_degrees_of_freedom(turn: float, verdict: str) -> None:
    found = found_of(reduced(of_chain, turn), Claims(order=2), hamiltonian=CHAIN)
    assert found.verdict == verdict, found.reason
    noted = "q2 is compared modulo 6.28319, a period of the motion" in found.notes
    assert noted is (verdict == "MEASURED")


@pytest.mark.parametrize(
    ("formula", "periods"),
    [
        ("p**2/2 - cos(q)", (0, TURN)),
        ("p**2/2 - cos(q)**2", (0, math.pi)),
        ("p**2/2 + q - cos(q)", (0, TURN)),  # the force alone repeats
        ("cos(p) + cos(3*q) + sin(5*q/2)", (TURN, 2 * TURN)),
        ("p**2/2 + cos(q) + cos(sqrt(2)*q)", (0, 0)),
        ("p**2/2 + q**2*cos(q)", (0, 0)),
        ("p**2/2 - cos(q - t)", (0, TURN)),
        ("p**2/2 + q**4", (0, 0)),
    ],
)
def test_periods(formula: str, periods: tuple[float, ...]) -> None:
    found = periods_of(Hamiltonian.parse(formula))
    assert [float(x) for x in found] == pytest.approx(periods, rel=1e-14)
    assert all(isinstance(x, Fraction) for x in found)
