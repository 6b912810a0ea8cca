"""A step that reduces its angles is compared modulo a period of the field, and of nothing else."""

import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.end_to_end.test_command_line import here
from tests.helpers.programs import user_steps
from tests.helpers.programs.judged import PENDULUM, judged
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.wrap_periods import find_wrapped_periods, periods_of, unwrap
from verify.integrators.results import Claims
from verify.verdict import Verdict

Step = Callable[..., Any]
PI = Fraction(math.pi)
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


def forces(q: Any) -> Any:
    bent = np.sin(q[0] - q[1])
    return -np.array([np.sin(q[0]) + bent, 2 * np.sin(2 * q[1]) - bent])


def of_chain(p: Any, q: Any, h: Any) -> Any:
    p = p + h / 2 * forces(q)
    q = q + h * p
    return p + h / 2 * forces(q), q


# -- periods -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formula", "turns"),
    [
        ("p**2/2 - cos(q)", [0, 1]),
        ("p**2/2 - cos(3*q/2)", [0, Fraction(2, 3)]),
        ("p**2/2 - cos(q)**2", [0, Fraction(1, 2)]),
        ("p**2/2 - cos(2*q) - sin(3*q)/2", [0, 1]),
        ("cos(p)*cos(q)", [1, 1]),
        ("p**2/2 - cos(q) + q/7", [0, 1]),  # the force repeats, though H does not
        ("p**2/2 - cos(q) + q**2/1000", [0, 0]),
        ("p**2/2 - cos(q) + q**2/10**25", [0, 0]),
        ("p**2/2 - cos(q) - cos(sqrt(2)*q)", [0, 0]),
        ("p**2/2 + p*sin(q) + q**4/4", [0, 0]),
        ("p**2/2 + q - cos(q)", [0, 1]),
        ("cos(p) + cos(3*q) + sin(5*q/2)", [1, 2]),
        ("p**2/2 + cos(q) + cos(sqrt(2)*q)", [0, 0]),
        ("p**2/2 + q**2*cos(q)", [0, 0]),
        ("p**2/2 + q**4", [0, 0]),
        ("p**2/2 - cos(q - t)", [0, 1]),
        ("p**2/2 - cos(q)*cos(t)", [0, 1]),
        ("p**2/2 + q**2/2", [0, 0]),
        ("sqrt(1/2 - p) - cos(q)", [0, 1]),  # at two of the points; and at one, which is too few
        ("sqrt(1/5 - p) - cos(q)", [0, 0]),
        ("p1**2/2 + p2**2/2 - cos(q1) - cos(q1 - q2)", [0, 0, 1, 1]),
        ("p1**2/2 + p2**2/2 - cos(q1) - cos(q1 - q2) + q2**2/10**20", [0, 0, 1, 0]),
    ],
)
def test_a_coordinate_has_the_period_of_the_field(formula: str, turns: list[Fraction]) -> None:
    text = formula.replace("10**25", f"{10**25}").replace("10**20", f"{10**20}")
    found = periods_of(Hamiltonian.parse(text))
    assert all(isinstance(x, Fraction) for x in found)
    assert [x / (2 * PI) for x in found] == pytest.approx([float(x) for x in turns], abs=1e-14)


def test_a_step_is_compared_modulo_what_it_reduces_and_nothing_else() -> None:
    """Ends that are a whole number of periods from the flow's; and others."""
    pendulum, (_, period) = (
        Hamiltonian.parse("p**2/2 - cos(q)"),
        periods_of(Hamiltonian.parse("p**2/2 - cos(q)")),
    )
    flow, h = (Fraction(1), Fraction(7)), Fraction(1, 10**6)
    assert find_wrapped_periods([(flow, flow)], pendulum, h) == ()
    for k in (-2, -1, 1):
        ends = [((flow[0], flow[1] + k * period), flow), (flow, flow)]
        assert find_wrapped_periods(ends, pendulum, h) == (0, period)
    for off in (Fraction(1, 50), Fraction(1, 2), period / 2):
        assert find_wrapped_periods([((flow[0], flow[1] + period + off), flow)], pendulum, h) == ()
    assert find_wrapped_periods([((flow[0] + period, flow[1]), flow)], pendulum, h) == ()
    assert unwrap(flow[1] + 3 * period, Fraction(6), period) == flow[1]
    assert unwrap(flow[1], Fraction(6), Fraction(0)) == flow[1]


# -- steps -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("step", "system", "name"),
    [
        pytest.param(reduced(verlet), PENDULUM, "q", id="from 0"),
        pytest.param(reduced(verlet, least=-math.pi), PENDULUM, "q", id="from -pi"),
        pytest.param(reduced(verlet, 2 * TURN), PENDULUM, "q", id="two turns"),
        pytest.param(by_branches, PENDULUM, "q", id="by branches"),
        pytest.param(reduced(of_chain), CHAIN, "q2", id="n = 2"),
    ],
)
def test_a_right_step_that_reduces_its_angle_is_measured(
    step: Step, system: Hamiltonian, name: str
) -> None:
    found = judged(step, CLAIMS, hamiltonian=system)
    assert (found.verdict, found.convergence_order) == (Verdict.MEASURED, 2), found.reason
    assert found.area_preserving is True
    assert f"{name} is compared modulo 6.28319, a period of the motion" in found.notes


def test_where_nothing_is_reduced_no_period_is_told() -> None:
    for found in (judged(reduced(verlet, 9 * TURN, -4 * TURN)), judged(verlet, CLAIMS)):
        assert not any("modulo" in note for note in found.notes)


NOT_AT_0 = "does not vanish as h → 0"


@pytest.mark.parametrize(
    ("step", "system", "words"),
    [
        pytest.param(
            reduced(contracting), PENDULUM, "det J ≡ 1 is claimed; ΔJ has order 3", id="contracting"
        ),
        pytest.param(
            reduced(too_weak), PENDULUM, "the map agrees with the exact flow up to h^0 only",
            id="too weak",
        ),
        pytest.param(
            reduced(verlet, 6.28), PENDULUM, f"the map's distance from the exact flow {NOT_AT_0}",
            id="6.28",
        ),
        pytest.param(reduced(verlet, 6.2832), PENDULUM, NOT_AT_0, id="6.2832"),
        pytest.param(reduced(of_chain, 6.283), CHAIN, NOT_AT_0, id="n = 2"),
    ],
)  # fmt: skip
def test_an_error_beside_it_is_refuted(step: Step, system: Hamiltonian, words: str) -> None:
    found = judged(step, CLAIMS, hamiltonian=system)
    assert (found.verdict, words in found.reason) == (Verdict.REFUTED, True), found.reason
    assert "h^-1" not in found.reason
    assert system is PENDULUM or not any("modulo" in note for note in found.notes)


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
    assert judged(step, CLAIMS, hamiltonian=harmonic).verdict is Verdict.PROVED
    assert judged(reduced(step), CLAIMS, hamiltonian=harmonic).verdict is Verdict.REFUTED
