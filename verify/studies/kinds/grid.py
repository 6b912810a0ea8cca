"""Runs of every scheme over step sizes and initial values."""

from fractions import Fraction
from typing import Any

from verify import observables
from verify.execution.plan import Plan
from verify.execution.study import Results, Study, results_of_tasks, scene_name, toml_section
from verify.kernels.run_inputs import SECTIONS
from verify.observables.observable import has_no_defect
from verify.runs.digits_on_demand import WORTH_COMPILING
from verify.runs.task import RunTask
from verify.scenes.observables import select_observables
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.separation.links import way_for
from verify.studies.separation.task import serves_first_link
from verify.studies.separation.ways.determinants import POINTS


def grid_task(
    scene: Scene, scheme: str, h: Fraction, start: int, common: dict[str, Any] | None = None
) -> RunTask:
    """Return the grid's run for a step size and the index of an initial value.

    `common`: the fields that all runs have in common, computed once where there are several.
    """
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    initial_value, steps = scene.grid.initial_values[start], scene.grid.steps_for(h)
    fields = common or _common_fields(scene)
    return RunTask(
        **fields, scheme=scheme, step_size=h, steps=steps, q=initial_value.q, p=initial_value.p
    )


def grid_tasks(scene: Scene, scheme: str) -> list[RunTask]:
    """Return the grid's runs by initial value, then step size; none where there is no grid."""
    if scene.grid is None:
        return []
    common = _common_fields(scene)
    return [
        grid_task(scene, scheme, h, start, common)
        for start in range(len(scene.grid.initial_values))
        for h in scene.grid.step_sizes
    ]


def _common_fields(scene: Scene) -> dict[str, Any]:
    """Return the fields that all runs of the grid have in common; they need H, which takes long."""
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    grid = scene.grid
    return scene.hamiltonian_fields() | {
        "t0": scene.t0, "arithmetic": grid.arithmetic, "digits": grid.digits, "points": 0,
        "observables": select_observables(scene.exact_hamiltonian(), grid.observables),
        "sections": POINTS if shares_runs(scene) else SECTIONS,
        "shares_kernel": grid.runs > 1 and grid.steps_in_all >= WORTH_COMPILING,
    }  # fmt: skip


def shares_runs(scene: Scene) -> bool:
    """Return True if the grid's runs are also the first links of its separations."""
    grid = scene.grid
    if grid is None or not grid.separate:
        return False
    exact = scene.exact_hamiltonian()
    has_links = way_for(exact).observables <= set(select_observables(exact, grid.observables))
    return has_links and serves_first_link(grid.arithmetic, grid.digits)


def grid_runs(scene: Scene, scheme: str, results: Results) -> list[RunResult]:
    """Return the results of the grid's runs that were needed, in the same order."""
    return results_of_tasks(RunResult, grid_tasks(scene, scheme), results)


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, tasks = scene_name(scene), grid_tasks(scene, scheme)
    exact = scene.exact_hamiltonian()
    observable_names = (
        set(select_observables(exact, scene.grid.observables)) if scene.grid else set()
    )
    every = observables.by_name()
    vanishing = {name for name, each in every.items() if each.vanishes is has_no_defect}
    # Observables that measure the loss of area are exactly 0: no run is needed for them alone.
    if preserves and observable_names and observable_names <= vanishing:
        also = {AREA: "", SYMPLECTIC: "S, W, "}[exact.structure]
        why = f"{exact.structure.identity} is proved: {also}ΔJ, MSE and Λ are exactly 0"
        plan.leave_out(f"{name}: {len(tasks)} runs of {scheme}", why)
        return
    for task in tasks:
        plan.need(task, f"{name}: grid")


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    return {"runs": tuple(r for name in scene.schemes for r in grid_runs(scene, name, results))}


_SECTION = toml_section(1, "runs over step sizes", "[grid]")
STUDY = Study(2, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
