"""Which number system the runs of a grid take: many short runs repay one compiled kernel."""

from fractions import Fraction

from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene, scene_from
from verify.studies.kinds.grid import grid_runs
from verify.studies.tasks_of_scenes import plan_scenes


def grid(starts: int) -> Scene:
    return scene_from(
        {
            "system": "duffing", "parameters": {"delta": 1}, "schemes": ["lie2"],
            "grid": {
                "steps": 1500, "step_sizes": ["0.01"], "digits": 20,
                "initial_values": [{"q": f"{10 + k}/20", "p": 0} for k in range(starts)],
            },
        },
        "grid",
    )  # fmt: skip


def computed(scene: Scene) -> list[RunResult]:
    results = execute(plan_scenes([scene]), Store(None), where=THIS_PROCESS)
    return grid_runs(scene, "lie2", results)


def test_short_runs_are_compiled_where_there_are_many_and_their_digits_are_the_same() -> None:
    few, many = computed(grid(3)), computed(grid(40))
    assert {run.arithmetic for run in few} == {"mpfr"}
    assert {run.arithmetic for run in many} == {"fixed"}
    assert {run.error_kind for run in (*few, *many)} == {"enclosed"}
    for alone, beside in zip(few, many, strict=False):
        for name, value in alone.values.items():
            other = beside.values[name]
            gap = abs(Fraction(value.value) - Fraction(other.value))
            assert gap <= Fraction(value.bound) + Fraction(other.bound)


def test_a_run_is_one_task_in_two_grids_of_which_neither_repays_it() -> None:
    plan = plan_scenes([grid(2), grid(3)])
    assert len([task for task in plan.tasks.values() if task.kind == "run"]) == 3
