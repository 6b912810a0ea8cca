"""Runs of equations without an H in a scene, held against a step written by hand."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import load
from verify.claims.verdicts import make_report
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.exploration.sample import Sample
from verify.pages.page import render
from verify.runs.requested_run import run
from verify.scenes.results.report import Report
from verify.scenes.scene import Scene, scene_from_toml, scene_text
from verify.studies.tasks_of_scenes import plan_scenes

H, N = Fraction(1, 10), 10
TURN = """
field = "x_dot = y; y_dot = -w*x"
parameters = { w = 1 }
schemes = ["A 1/2; B 1; A 1/2", "rk4"]
keeps = ["w*x**2 + y**2: 3", "volume: 6"]
[[split]]
name = "A"
field = "x_dot = y"
[[split]]
name = "B"
field = "y_dot = -w*x"
"""
RUNS = """
[grid]
steps = 10
step_sizes = [0.1, 0.05]
initial_values = [{ x = 1, y = "1/2" }]
digits = 20
[[series]]
steps = 10
step_size = 0.1
initial_value = { y = 0.5, x = 1 }
"""
STEPS = "A 1/2; B 1; A 1/2"


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return load(tmp_path_factory.mktemp("scene"), TURN + RUNS)


@pytest.fixture(scope="module")
def report(scene: Scene) -> Report:
    return make_report("x", [scene], (), Store(None), command="x", where=THIS_PROCESS)


def test_a_scene_is_read_as_it_is_written(scene: Scene) -> None:
    assert scene_from_toml(scene_text(scene), "mine.toml") == scene
    assert scene.schemes[0] == f"{STEPS} with A: x_dot = y; B: y_dot = -w*x"


def test_the_integral_changes_as_it_does_by_hand(report: Report) -> None:
    x, y, changes = Fraction(1), Fraction(1, 2), [Fraction(0)]
    for _ in range(N):
        x += H / 2 * y
        y -= H * x
        x += H / 2 * y
        changes.append(x**2 + y**2 - Fraction(5, 4))
    (first, *_) = report.scenes[0].runs
    value = first.values["integral_error_max: x**2 + y**2"]
    assert (first.scheme, first.error_kind) == (report.scenes[0].keeps[0].scheme, "enclosed")
    assert abs(Fraction(value.value) - max(map(abs, changes))) <= Fraction(value.bound)
    assert (first.values["lambda"].value, first.start) == ("0", {"x": "1", "y": "0.5"})
    assert abs(Fraction(first.values["x"].value) - x) <= Fraction(first.values["x"].bound)


def test_volume_of_rk4_changes_as_it_does_by_hand(report: Report) -> None:
    # Of the harmonic oscillator RK4 has det J = (1 − h²/2 + h⁴/24)² + (h − h³/6)².
    rk4 = next(r for r in report.scenes[0].runs if (r.scheme, r.step_size) == ("rk4", "0.1"))
    determinant = (1 - H**2 / 2 + H**4 / 24) ** 2 + (H - H**3 / 6) ** 2
    value = rk4.values["lambda"]
    assert abs(Fraction(value.value) - (determinant**N - 1)) <= Fraction(value.bound)


def test_a_run_of_a_scene_is_that_of_the_command(scene: Scene, report: Report) -> None:
    start = {"x": 1, "y": "1/2"}
    system = scene.exact_hamiltonian()
    alone = run(system, scene.schemes[0], start=start, step_size="0.1", steps=N,
                arithmetic="auto", digits=20)  # fmt: skip
    values = report.scenes[0].runs[0].values
    assert {name: values[name] for name in alone.values} == alone.values


def test_the_page_shows_steps_in_titles_and_their_parts_once(report: Report) -> None:
    page = render(report)
    assert f"Scheme <code>{STEPS}</code>" in page
    assert page.count("A: x_dot = y; B: y_dot = -w*x") == 1
    assert "x₀ = 1, y₀ = 0.5" in page.replace("\xa0", " ")
    assert "ΔJ = det J − 1 and Λ over time, h = 0.1" in page
    assert "|Λ| and MSE/|Λ|" in page


def test_a_flow_that_does_not_keep_volume_has_runs_and_no_error_of_volume(tmp_path: Path) -> None:
    damped = TURN.replace("-w*x", "-w*x - y").partition("[[split]]")[0]
    damped = damped.replace('"A 1/2; B 1; A 1/2", ', "").replace("keeps", "# keeps")
    scene = load(tmp_path, damped + RUNS)
    report = make_report("x", [scene], (), Store(None), command="x", where=THIS_PROCESS)
    assert (report.scenes[0].keeps, len(report.scenes[0].runs)) == ((), 2)
    page = render(report)
    assert "Scheme <code>rk4</code>" in page
    assert "|Λ| and MSE/|Λ|" not in page


def test_what_a_proof_gives_is_left_out_and_named_by_its_steps(tmp_path: Path) -> None:
    volume = TURN.replace('"w*x**2 + y**2: 3", "volume: 6"', '"volume"').replace(', "rk4"', "")
    plan = plan_scenes([load(tmp_path, volume + RUNS)])
    assert {task.kind for task in plan.tasks.values()} == {"keeps"}
    assert [what for what, _ in plan.left_out] == [
        f"mine: 2 runs of {STEPS}", f"mine: series of {STEPS} at h = 0.1"
    ]  # fmt: skip


def test_what_takes_an_h_refuses_a_scene_of_a_field_that_has_a_grid(scene: Scene) -> None:
    with pytest.raises(InputError, match="has no H"):
        Sample.from_scene(scene)
