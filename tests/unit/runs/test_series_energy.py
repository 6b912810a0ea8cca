"""H − H₀ in the series of a run, and the bounds of a run with a series that solves equations."""

from fractions import Fraction
from typing import Any

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
OSCILLATOR = Hamiltonian.parse("(p**2 + q**2)/2")
START: dict[str, Any] = {"q": "0.1", "p": 0, "step_size": "0.1"}


@pytest.mark.parametrize("arithmetic", ["float64", "mpfr"])
def test_a_series_has_the_energy_after_the_last_step_of_each_point(arithmetic: str) -> None:
    result = run(
        OSCILLATOR, "rk4", **START, steps=40, points=8, arithmetic=arithmetic,
        observables=["energy_error_max"],
    )  # fmt: skip
    # RK4 takes the energy by the same factor in each step: 1 − h⁶/72 + h⁸/576.
    h = Fraction(1, 10)
    factor = 1 - h**6 / 72 + h**8 / 576
    assert [x.last for x in result.series] == [5 * k for k in range(1, 9)]
    for point in result.series:
        error = (factor**point.last - 1) / 200
        assert point.energy is not None
        assert float(point.energy) == pytest.approx(float(error), rel=1e-6)


def test_a_run_that_asks_for_no_energy_has_none_in_its_series() -> None:
    result = run(PENDULUM, "lie2", **START, steps=40, points=8, observables=["mse"])
    assert {x.energy for x in result.series} == {None}


def test_an_h_in_time_has_no_energy_to_keep() -> None:
    driven = Hamiltonian.parse("p**2/2 - cos(q)*cos(t)")
    result = run(driven, "lie2", **START, steps=40, points=8)
    assert len(result.series) == 8
    assert {x.energy for x in result.series} == {None}


@pytest.mark.parametrize("points", [0, 50])
def test_notes_of_a_series_are_compared_with_those_of_the_same_steps(points: int) -> None:
    result = run(
        PENDULUM, "implicit-midpoint", q="1.5", p=0, step_size="0.1", steps=400, points=points,
        observables=["energy_error_max"],
    )  # fmt: skip
    assert result.status == "finished"
    assert float(result.values["energy_error_max"].value) == pytest.approx(3.59e-4, rel=2e-3)
