"""Runs of every scheme over step sizes and initial values."""

from fractions import Fraction
from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Study, called, known_results, toml_section
from verify.runs.digits_on_demand import WORTH_COMPILING
from verify.runs.task import RunTask
from verify.scenes.observables import OF_FORM, observed
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import CLOSED_FORM


def grid_task(scene: Scene, scheme: str, h: Fraction, start: int) -> RunTask:
    """The grid's run for a step size and the index of an initial value."""
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    grid, at = scene.grid, scene.grid.initial_values[start]
    observables = observed(scene.exact_hamiltonian(), grid.observables)
    return RunTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        step_size=h, steps=grid.steps_for(h), q=at.q, p=at.p, t0=scene.t0,
        arithmetic=grid.arithmetic, digits=grid.digits, observables=observables, points=0,
        shares_kernel=grid.runs > 1 and grid.steps_in_all >= WORTH_COMPILING,
    )  # fmt: skip


def grid_tasks(scene: Scene, scheme: str) -> list[RunTask]:
    """The grid's runs by initial value, then step size; none where there is no grid."""
    if scene.grid is None:
        return []
    return [
        grid_task(scene, scheme, h, start)
        for start in range(len(scene.grid.initial_values))
        for h in scene.grid.step_sizes
    ]


def grid_runs(scene: Scene, scheme: str, results: Results) -> list[RunResult]:
    """Those that were needed, in the same order."""
    return known_results(RunResult, grid_tasks(scene, scheme), results)


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, tasks = called(scene), grid_tasks(scene, scheme)
    exact = scene.exact_hamiltonian()
    asked = set(observed(exact, scene.grid.observables)) if scene.grid else set()
    if preserves and asked and asked <= {*CLOSED_FORM, *OF_FORM}:
        why = "ΔJ ≡ 0 is proved: ΔJ, MSE and Λ are exactly 0"
        if not exact.planar:
            why = "S ≡ 0 is proved: S, W, ΔJ, MSE and Λ are exactly 0"
        plan.leave_out(f"{name}: {len(tasks)} runs of {scheme}", why)
        return
    for task in tasks:
        plan.need(task, f"{name}: grid")


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    return {"runs": tuple(r for name in scene.schemes for r in grid_runs(scene, name, results))}


_SECTION = toml_section(1, "runs over step sizes", "[grid]")
STUDY = Study(2, (_SECTION,), need_of_scheme=_need, found=_found)
