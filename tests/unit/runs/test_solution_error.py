"""How far a run is from the exact solution: in closed form, and followed from state to state."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

import verify
from verify.flows.solution import ExactSolution, Point
from verify.hamiltonians import flow_recognition
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs import run_errors
from verify.runs.run_errors import solution_errors
from verify.scenes.results.run import RunResult

DRIVEN = {"gamma": "1/3", "omega": "3/2", "omega0": 1}


@pytest.fixture(scope="module")
def run() -> RunResult:
    return verify.run("pendulum", "lie2", q=1, p=0.5, step_size=0.05, steps=20, digits=20)


def test_in_the_plane_of_the_oscillator_it_is_what_the_closed_form_says() -> None:
    found = verify.run("p**2/2 + q**2/2", "euler", q=1, p=0, step_size=0.1, steps=2, digits=30)
    (t_0, first), (_, _), (t_2, last) = solution_errors(found)
    assert (t_0, t_2, float(first)) == (0, Fraction(1, 5), 0)
    # Two Euler steps from (1, 0): q = 0.99, p = -0.2; cos 0.2 and -sin 0.2 to 12 digits.
    off = ((0.99 - 0.980066577841) ** 2 + (-0.2 + 0.198669330795) ** 2) ** 0.5
    assert float(last) == pytest.approx(off, rel=1e-6)


def test_followed_from_state_to_state_it_is_the_same(
    run: RunResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = solution_errors(run, 4)
    monkeypatch.setattr(flow_recognition, "closed_form", lambda *_: None)
    followed = solution_errors(run, 4)
    assert [t for t, _ in closed] == [t for t, _ in followed]
    for (_, x), (_, y) in zip(closed, followed, strict=True):
        assert abs(Fraction(x.value) - Fraction(y.value)) <= Fraction(x.bound) + Fraction(y.bound)
        assert Fraction(y.bound) < Fraction(1, 10**9)


def test_what_is_lost_on_the_way_is_in_the_bound(
    run: RunResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A solution that says more than it knows is found out by the one of a single piece."""
    true, lost = run_errors.solution_from, Fraction(1, 10**4)

    def careless(h: Hamiltonian, at: Point, time: Fraction, *rest: Any) -> ExactSolution:
        found = true(h, at, time, *rest)
        moved = {**found.point, "p": found.point["p"] + lost}
        return found if time == 1 else replace(found, point=moved)

    monkeypatch.setattr(flow_recognition, "closed_form", lambda *_: None)
    monkeypatch.setattr(run_errors, "solution_from", careless)
    assert all(Fraction(x.bound) > lost for _, x in solution_errors(run, 4))


@pytest.mark.parametrize("t0", ["0", "1/3", "-2"])
@pytest.mark.parametrize("closed", [True, False])
def test_in_time_the_solution_is_that_from_t0_on(
    t0: str, closed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """p' = t, q' = p: from (q, p) = (1, 0) p is (t² − t₀²)/2, whatever the scheme makes of it."""
    found = verify.run("p**2/2 - q*t", "lie1", q=1, p=0, step_size="1/10", steps=6, t0=t0,
                       digits=25)  # fmt: skip
    if not closed:
        monkeypatch.setattr(flow_recognition, "closed_form", lambda *_: None)
    errors = solution_errors(found, 10)
    begun, h = Fraction(t0), Fraction(1, 10)
    assert [t for t, _ in errors] == [begun + k * h for k in range(7)]
    p = q = Fraction(0)
    for t, error in errors:
        s = t - begun
        true_p = (t * t - begun * begun) / 2
        true_q = begun * s * s / 2 + s**3 / 6
        size = float((p - true_p) ** 2 + (q - true_q) ** 2) ** 0.5
        assert abs(float(error) - size) <= 1e-9 * size + float(Fraction(error.bound)) + 1e-15
        p, q = p + h * t, q + h * p


@pytest.mark.parametrize("t0", ["1/3", "-2"])
def test_of_a_driven_oscillator_the_closed_form_begins_at_t0_too(
    t0: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = verify.run("forced-oscillator", "lie2", parameters=DRIVEN,
                       q=1, p=0, step_size="1/10", steps=6, t0=t0, digits=20)  # fmt: skip
    closed = solution_errors(found, 6)
    monkeypatch.setattr(flow_recognition, "state_in_time", lambda *_: None)
    followed = solution_errors(found, 6)
    for (t, x), (s, y) in zip(closed, followed, strict=True):
        assert t == s
        assert abs(Fraction(x.value) - Fraction(y.value)) <= Fraction(x.bound) + Fraction(y.bound)
        assert max(Fraction(x.bound), Fraction(y.bound)) < Fraction(1, 10**9)
