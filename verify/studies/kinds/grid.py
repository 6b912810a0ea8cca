"""Runs of every scheme over step sizes and initial values."""

from fractions import Fraction
from typing import Any

from verify import observables
from verify.execution.plan import Plan
from verify.execution.study import Results, Study, called, known_results, toml_section
from verify.kernels.run_inputs import SECTIONS
from verify.observables.observable import of_defect
from verify.runs.digits_on_demand import WORTH_COMPILING
from verify.runs.task import RunTask
from verify.scenes.observables import observed
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.separation.links import way_of
from verify.studies.separation.task import does_for_first_link
from verify.studies.separation.ways.determinants import POINTS


def grid_task(
    scene: Scene, scheme: str, h: Fraction, start: int, of_all: dict[str, Any] | None = None
) -> RunTask:
    """The grid's run for a step size and the index of an initial value.

    `of_all`: what all runs have in common, where several are asked for.
    """
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    at, steps = scene.grid.initial_values[start], scene.grid.steps_for(h)
    shared = of_all or _fields_of_all(scene)
    return RunTask(**shared, scheme=scheme, step_size=h, steps=steps, q=at.q, p=at.p)


def grid_tasks(scene: Scene, scheme: str) -> list[RunTask]:
    """The grid's runs by initial value, then step size; none where there is no grid."""
    if scene.grid is None:
        return []
    of_all = _fields_of_all(scene)
    return [
        grid_task(scene, scheme, h, start, of_all)
        for start in range(len(scene.grid.initial_values))
        for h in scene.grid.step_sizes
    ]


def _fields_of_all(scene: Scene) -> dict[str, Any]:
    """What all runs of the grid have in common; for it H is read, which takes long."""
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    grid = scene.grid
    return scene.hamiltonian_fields() | {
        "t0": scene.t0, "arithmetic": grid.arithmetic, "digits": grid.digits, "points": 0,
        "observables": observed(scene.exact_hamiltonian(), grid.observables),
        "sections": POINTS if shares_runs(scene) else SECTIONS,
        "shares_kernel": grid.runs > 1 and grid.steps_in_all >= WORTH_COMPILING,
    }  # fmt: skip


def shares_runs(scene: Scene) -> bool:
    """Whether the grid's runs are its separations' first links too."""
    grid = scene.grid
    if grid is None or not grid.separate:
        return False
    exact = scene.exact_hamiltonian()
    has_links = way_of(exact).observables <= set(observed(exact, grid.observables))
    return has_links and does_for_first_link(grid.arithmetic, grid.digits)


def grid_runs(scene: Scene, scheme: str, results: Results) -> list[RunResult]:
    """Those that were needed, in the same order."""
    return known_results(RunResult, grid_tasks(scene, scheme), results)


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, tasks = called(scene), grid_tasks(scene, scheme)
    exact = scene.exact_hamiltonian()
    asked = set(observed(exact, scene.grid.observables)) if scene.grid else set()
    every = observables.by_name()
    vanishing = {name for name, each in every.items() if each.vanishes is of_defect}
    if preserves and asked and asked <= vanishing:
        also = {AREA: "", SYMPLECTIC: "S, W, "}[exact.structure]
        why = f"{exact.structure.identity} is proved: {also}ΔJ, MSE and Λ are exactly 0"
        plan.leave_out(f"{name}: {len(tasks)} runs of {scheme}", why)
        return
    for task in tasks:
        plan.need(task, f"{name}: grid")


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    return {"runs": tuple(r for name in scene.schemes for r in grid_runs(scene, name, results))}


_SECTION = toml_section(1, "runs over step sizes", "[grid]")
STUDY = Study(2, (_SECTION,), need_of_scheme=_need, found=_found)
