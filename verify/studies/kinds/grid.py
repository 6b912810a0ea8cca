"""Runs of every scheme over step sizes and initial values."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from verify import observables
from verify.arithmetic.systems import ball, float64
from verify.execution.plan import Plan, Results, Study, results_of_tasks, scene_name, toml_section
from verify.kernels.run_inputs import DEFAULT_SECTIONS
from verify.observables.observable import has_no_defect
from verify.runs.digits_on_demand import WORTH_COMPILING
from verify.runs.task import RunTask
from verify.scenes.observables import select_observables
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import start_arguments
from verify.schemes.field_splitting import separate_parts
from verify.structures import SYMPLECTIC
from verify.studies.separation.determinants import POINTS, Determinants
from verify.studies.separation.links import way_for

SEPARATION_DIGITS = 6  # of each part of a separation


def grid_task(
    scene: Scene, scheme: str, h: Fraction, start: int, common: dict[str, Any] | None = None
) -> RunTask:
    """Return the grid's run for a step size and the index of an initial value.

    `common`: the fields that all runs have in common, computed once where there are several.
    """
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    initial_value, steps = scene.grid.initial_values[start], scene.grid.steps_for(h)
    fields = common or _common_fields(scene)
    begin = start_arguments(initial_value, of_field=scene.field is not None)
    return RunTask(**fields, **begin, scheme=scheme, step_size=h, steps=steps)


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
        "observables": observables_of(scene, grid.observables),
        "sections": POINTS if shares_runs(scene) else DEFAULT_SECTIONS,
        "shares_kernel": grid.runs > 1 and grid.steps_in_all >= WORTH_COMPILING,
    }  # fmt: skip


def observables_of(scene: Scene, requested: Sequence[str] | None) -> tuple[str, ...]:
    """Return the requested observables of runs; by default the usual ones, and those of what the
    scene asks whether a step keeps it."""
    hamiltonian = scene.exact_hamiltonian()
    names = select_observables(hamiltonian, requested)
    if requested is not None or scene.keeps is None:
        return names
    return tuple(dict.fromkeys((*names, *scene.keeps.observables(hamiltonian))))


def shares_runs(scene: Scene) -> bool:
    """Return True if the grid's runs are also the first links of its separations."""
    grid = scene.grid
    if grid is None or not grid.separate:
        return False
    observable_names = set(observables_of(scene, grid.observables))
    has_links = way_for(scene.exact_hamiltonian()).observables <= observable_names
    return has_links and serves_first_link(grid.arithmetic, grid.digits)


def serves_first_link(arithmetic: str, digits: int) -> bool:
    """Return True if a run in that arithmetic is certified to enough digits for the first link."""
    least = SEPARATION_DIGITS + Determinants.cancelled
    return arithmetic not in (float64.NAME, ball.NAME) and digits >= least


def grid_runs(scene: Scene, scheme: str, results: Results) -> list[RunResult]:
    """Return the results of the grid's runs that were needed, in the same order."""
    return results_of_tasks(RunResult, grid_tasks(scene, scheme), results)


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, tasks = scene_name(scene), grid_tasks(scene, scheme)
    hamiltonian = scene.exact_hamiltonian()
    observable_names = set(observables_of(scene, scene.grid.observables)) if scene.grid else set()
    catalogue = observables.by_name().items()
    vanishing = {name for name, entry in catalogue if entry.vanishes is has_no_defect}
    # Observables that measure the loss of area are exactly 0: no run is needed for them alone.
    if preserves and observable_names and observable_names <= vanishing:
        structure = hamiltonian.structure
        of_form = "S, W, " if structure is SYMPLECTIC else ""
        reason = f"{structure.identity} is proved: {of_form}ΔJ, MSE and Λ are exactly 0"
        plan.leave_out(f"{name}: {len(tasks)} runs of {separate_parts(scheme)[0]}", reason)
        return
    for task in tasks:
        plan.need(task, f"{name}: grid")


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    return {"runs": tuple(r for name in scene.schemes for r in grid_runs(scene, name, results))}


_SECTION = toml_section(1, "runs over step sizes", "[grid]")
STUDY = Study(2, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect, takes_field=True)
