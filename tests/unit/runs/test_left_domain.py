"""A run that steps over a pole of H, or beyond where H is defined, is told to; others are not."""

import math
from fractions import Fraction
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.commands.main import cli
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run

LOG, POLE = "p**2/2 + q**2/2 + log(q)", "p**2/2 - 1/q"
WELL = "p**2/2 + q**2/2 + 1/q"  # whose pole repels


def told(formula: str, scheme: str = "stormer-verlet", **changes: Any) -> str:
    given_ = {"q": Fraction(1, 2), "p": 0, "step_size": Fraction(1, 10), "steps": 100} | changes
    return run(Hamiltonian.parse(formula), scheme, **given_).left_domain


@pytest.mark.parametrize("more", [{}, {"arithmetic": "mpfr", "digits": 20}, {"points": 50}])
def test_what_steps_over_a_pole_is_told(more: dict[str, Any]) -> None:
    assert "the orbit has left where H is defined: q > 0" in told(LOG, **more)
    assert "q ≠ 0" in told(POLE, **more)
    assert told(WELL, **more) == ""


def test_it_is_told_by_the_first_noted_step_that_shows_it() -> None:
    q, p, h, step = 0.5, 0.0, 0.1, 0
    while q > 0:
        p -= h / 2 * (q + 1 / q)
        q += h * p
        p -= h / 2 * (q + 1 / q)
        step += 1
    for steps in range(step, step + 12):
        section = -(-steps // 16)
        noted = min(math.ceil(step / section) * section, steps)
        assert told(LOG, steps=steps).startswith(f"by step {noted} "), steps


def test_in_several_degrees_and_in_time_too() -> None:
    kepler = "p1**2/2 + p2**2/2 - 1/q1 - 1/q2"
    start = {"q": [Fraction(1, 2), Fraction(2)], "p": [0, 0]}
    assert "q1 ≠ 0" in told(kepler, **start)
    moving = "p**2/2 + q**2/2 + log(q + t/10)"
    assert "t" in told(moving).partition("defined: ")[2]
    assert told(moving, q=Fraction(3), steps=5) == ""


def test_where_h_is_defined_everywhere_nothing_is_looked_at() -> None:
    assert told("p**2/2 - cos(q)") == ""
    assert told("p**2/2 + sqrt(1 + q**2)") == ""


@drawn(30)
@given(st.fractions(Fraction(1, 5), 3), st.integers(1, 60))
def test_an_orbit_that_a_wall_holds_is_never_said_to_leave(q: Fraction, steps: int) -> None:
    h = Fraction(1, 50)
    found = run(
        Hamiltonian.parse(WELL), "stormer-verlet", q=q, p=0, step_size=h, steps=steps, points=steps
    )
    assert found.left_domain == ""


def test_people_and_programs_are_told() -> None:
    call = ["run", "--hamiltonian", LOG, "--scheme", "stormer-verlet", "--step-size", "0.1",
            "--steps", "100", "--q", "0.5", "--p", "0"]  # fmt: skip
    assert "has left where H is defined: q > 0" in CliRunner().invoke(cli, call).stdout
    assert '"left_domain": "by step 14' in CliRunner().invoke(cli, [*call, "--json"]).stdout
