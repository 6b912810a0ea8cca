"""The numbers of a scene are exact, and its steps and its arithmetic are those it asks for."""

from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.constructed.scenes import GRID, HEAD, SERIES, load
from verify.scenes.scene import Scene, load_scene, scene_text
from verify.studies.tasks_of_scenes import plan_scenes


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


SCENE = Scene(
    name="scene",
    title="τ",
    hamiltonian="p**2/2 + a*q**4",
    parameters={"a": "1/3"},
    schemes=("lie2",),
)


def read(text: str, folder: pytest.TempPathFactory) -> Scene:
    path = folder.mktemp("scene") / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return load_scene(path)


@drawn(60)
@given(st.text(st.characters(exclude_categories=("Cs",)), max_size=30))
@example("\x1b]0;x\x07 and \x00, \x7f, \x85, \u2028\nschemes = []")
@example('"""\r\n[grid]')
def test_a_comment_of_any_text_changes_nothing(
    tmp_path_factory: pytest.TempPathFactory, comment: str
) -> None:
    assert read(scene_text(SCENE, comment=comment), tmp_path_factory) == SCENE


@drawn(60)
@given(st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=30))
@example("quotes \"\\\" and [[tables]] # '''")
def test_a_title_reads_back(tmp_path_factory: pytest.TempPathFactory, title: str) -> None:
    scene = SCENE.model_copy(update={"title": title})
    assert read(scene_text(scene), tmp_path_factory) == scene
