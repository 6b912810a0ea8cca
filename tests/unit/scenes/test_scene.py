"""The numbers of a scene are exact, and its steps and its arithmetic are those it asks for."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import GRID, HEAD, SERIES, load
from verify.studies.plan import plan_scenes


def test_decimals_of_a_scene_are_exact(tmp_path: Path) -> None:
    scene = load(tmp_path, 'system = "duffing"\nschemes = ["lie2"]\nparameters = { delta = 0.1 }\n'
                 '[grid]\ntime = 3\nstep_sizes = [0.001, 2e-3, "1/3"]\n'
                 'initial_values = [{ q = 0.7, p = "-7/3" }]')  # fmt: skip
    assert scene.grid is not None
    assert scene.grid.step_sizes == (Fraction(1, 1000), Fraction(1, 500), Fraction(1, 3))
    assert scene.parameters == {"delta": Fraction(1, 10)}
    start = scene.grid.initial_values[0]
    assert (start.q, start.p) == (Fraction(7, 10), Fraction(-7, 3))
    assert [scene.grid.steps_for(h) for h in scene.grid.step_sizes] == [3000, 1500, 9]


@pytest.mark.parametrize(
    ("asked", "arithmetic"),
    [
        ("", "float64"),
        ("digits = 30\n", "auto"),
        ('arithmetic = "float64"\ndigits = 30\n', "float64"),
        ('arithmetic = "mpfr"\n', "mpfr"),
    ],
)
def test_digits_alone_ask_for_the_fastest_arithmetic_that_certifies_them(
    tmp_path: Path, asked: str, arithmetic: str
) -> None:
    scene = load(tmp_path, HEAD + GRID + asked + SERIES + asked)
    assert scene.grid is not None
    assert {scene.grid.arithmetic, *(x.arithmetic for x in scene.series)} == {arithmetic}
    assert {task["arithmetic"] for task in plan_scenes([scene]).as_json()["tasks"]
            if task["kind"] == "run"} == {arithmetic}  # fmt: skip


def test_the_steps_are_the_whole_ones_that_fit_into_the_time(tmp_path: Path) -> None:
    grid = load(tmp_path, HEAD + GRID.replace("[0.1]", "[0.3, 0.5, 1]")).grid
    assert grid is not None
    assert [grid.steps_for(h) for h in grid.step_sizes] == [3, 2, 1]
