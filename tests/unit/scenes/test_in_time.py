"""Scenes of an H that depends on time: when their runs start, and what of them takes no t."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import load
from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.runs.requested_run import run
from verify.runs.task import RunTask
from verify.scenes.results.proof_result import EveryResult, ProofResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import scene_from_toml, scene_text
from verify.studies.kinds.every import EveryTask
from verify.studies.tasks_of_scenes import plan_scenes

FROZEN = "kick 1/2 at 0; drift 1; kick 1/2 at 0; order 2"
HEAD = f"""
hamiltonian = "p**2/2 - (1 + eps*cos(2*t))*cos(q)"
parameters = {{ eps = "1/2" }}
t0 = "1/3"
schemes = ["lie2", "{FROZEN}"]
"""
GRID = """
[grid]
steps = 20
step_sizes = [0.1]
initial_values = [{ q = 1.5, p = 0 }]
arithmetic = "mpfr"
digits = 20
"""
AT = "initial_value = { q = 1, p = 0 }"


def results(folder: Path, text: str) -> list[object]:
    scene = load(folder, text)
    return list(execute(plan_scenes([scene]), Store(None), where=THIS_PROCESS).values())


def test_runs_of_a_scene_start_at_its_t0(tmp_path: Path) -> None:
    found = [x for x in results(tmp_path, HEAD + GRID) if isinstance(x, RunResult)]
    scene = load(tmp_path, HEAD)
    asked = {"q": 1.5, "p": 0, "step_size": "0.1", "steps": 20, "arithmetic": "mpfr", "digits": 20}
    same, early = (
        run(scene.exact_hamiltonian(), "lie2", t0=t0, **asked)  # type: ignore[arg-type]
        for t0 in (Fraction(1, 3), 0)
    )
    (result,) = found  # of the other scheme nothing is run: ΔJ ≡ 0
    assert (result.t0, result.values) == ("1/3", same.values)
    assert result.values["lambda"] != early.values["lambda"]


def test_proofs_are_of_h_in_time_and_a_clock_that_stands_still_is_refuted(tmp_path: Path) -> None:
    found = results(tmp_path, HEAD + "every_hamiltonian = true\n")
    one = {x.scheme: x for x in found if isinstance(x, ProofResult)}
    every = {x.scheme: x for x in found if isinstance(x, EveryResult)}
    assert (one["lie2"].verdict, one["lie2"].order) == ("PROVED", 3)
    assert "t" in one["lie2"].witness
    assert (one[FROZEN].verdict, one[FROZEN].convergence_order) == ("REFUTED", 1)
    assert every["lie2"].quantifier == "every smooth H(p, q, t)"
    assert every[FROZEN].verdict == "REFUTED"


def test_without_t_it_is_the_autonomous_scene(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, HEAD.replace("2*t", "2") + "every_hamiltonian = true\n")])
    assert not any(task.timed for task in plan.tasks.values() if isinstance(task, EveryTask))


def test_a_task_has_the_time_that_its_scene_has(tmp_path: Path) -> None:
    tasks = plan_scenes([load(tmp_path, HEAD + GRID)]).tasks.values()
    assert {task.t0 for task in tasks if isinstance(task, RunTask)} == {Fraction(1, 3)}


def test_a_scene_in_time_comes_back_from_its_text(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + GRID)
    assert scene_from_toml(scene_text(scene), "mine.toml") == scene
    assert "t0" not in scene_text(scene.model_copy(update={"t0": Fraction(0)}))


def test_growth_is_of_orbits_that_close_which_is_said_in_one_line(tmp_path: Path) -> None:
    section = GRID + "growth = true\n"
    with pytest.raises(InputError) as error:
        load(tmp_path, HEAD + section)
    assert "depends on t; [grid] with growth = true is of orbits that close" in str(error.value)
    assert "\n" not in str(error.value)
    load(tmp_path, HEAD.replace("2*t", "2") + section)  # without t it is a scene


def test_a_bad_t0_and_a_pole_on_the_way_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="soon"):
        load(tmp_path, HEAD.replace('"1/3"', '"soon"'))
    opened = HEAD.replace("cos(2*t)", "1/(1 - t)") + GRID
    with pytest.raises(InputError, match=r"at step 7, .*, H is not smooth"):
        results(tmp_path, opened)
