"""Truncation separated from rounding in Λ: of the grid's runs, and over step sizes beside it.

In n degrees of freedom it is W that is split.
"""

from collections.abc import Iterator, Sequence
from itertools import chain, repeat
from typing import Any, NamedTuple

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, results_of_tasks, scene_name
from verify.scenes.results.separation import Separation
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.kinds.grid import grid_tasks, shares_runs
from verify.studies.separation.separate import as_grid
from verify.studies.separation.task import DIGITS, FormSeparationTask, SeparationTask


class _Split(NamedTuple):
    """The task of a split, and its keys in a `SceneResult`: for the grid, and for other grids."""

    task: type[SeparationTask]
    own_key: str
    grid_key: str


_SPLITS = {
    AREA: _Split(SeparationTask, "separations", "crossovers"),
    SYMPLECTIC: _Split(FormSeparationTask, "form_separations", "form_crossovers"),
}


def _rows(scene: Scene, scheme: str, grid: Grid) -> Sequence[Sequence[SeparationTask]]:
    """Return the splits of the grid's runs, by initial value, then step size."""
    common = scene.hamiltonian_fields()
    task = _SPLITS[scene.exact_hamiltonian().structure].task
    shares = grid is scene.grid and shares_runs(scene)
    runs: Iterator[dict[str, Any]] = repeat({})
    if shares:  # they are in the same order
        runs = ({"run": run} for run in grid_tasks(scene, scheme))
    return [
        [
            task(
                **common, scheme=scheme, step_size=h, steps=grid.steps_for(h),
                **dict(initial_value), t0=scene.t0, digits=DIGITS, **next(runs),
            )
            for h in grid.step_sizes
        ]
        for initial_value in grid.initial_values
    ]  # fmt: skip


def _own_grids(scene: Scene) -> list[Grid]:
    return [scene.grid] if scene.grid and scene.grid.separate else []


def _further_grids(scene: Scene) -> list[Grid]:
    return [over.as_grid() for over in scene.separation]


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    structure = scene.exact_hamiltonian().structure
    title = f"{scene_name(scene)}: truncation separated from rounding"
    for grid in (*_own_grids(scene), *_further_grids(scene)):
        if preserves:
            without = f"{structure.identity} is proved: the truncation part is exactly 0"
            plan.leave_out(f"{title} for {scheme}", without)
            continue
        for task in chain.from_iterable(_rows(scene, scheme, grid)):
            plan.need(task, f"{title} in {structure.accumulated}")


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    split = _SPLITS[scene.exact_hamiltonian().structure]
    return {
        name: tuple(
            as_grid(separations)
            for scheme in scene.schemes
            for grid in grids
            for row in _rows(scene, scheme, grid)
            if (separations := results_of_tasks(Separation, row, results))
        )
        for name, grids in (
            (split.own_key, _own_grids(scene)),
            (split.grid_key, _further_grids(scene)),
        )
    }


_SECTION = Section(
    2,
    "truncation separated from rounding",
    "the scene has no [[separation]], and its [grid] does not say `separate = true`",
    lambda scene: [*_own_grids(scene), *_further_grids(scene)],
)
STUDY = Study(4, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
