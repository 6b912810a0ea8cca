"""Truncation separated from rounding in Λ: of the grid's runs, and over step sizes beside it."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called
from verify.scenes.results.separation import SeparationGrid, SeparationResult
from verify.scenes.scene import Grid, Scene
from verify.studies.separation.separate import as_grid
from verify.studies.separation.task import SeparationTask

_DIGITS = 6  # of each part


def separation_task(
    scene: Scene, scheme: str, grid: Grid, h: Fraction, start: int
) -> SeparationTask:
    """The split of the grid's run for a step size and the index of an initial value."""
    at = grid.initial_values[start]
    return SeparationTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        step_size=h, steps=grid.steps_for(h), q=at.q, p=at.p, digits=_DIGITS,
    )  # fmt: skip


def _rows(scene: Scene, scheme: str, grid: Grid) -> list[list[SeparationTask]]:
    """By initial value, then step size."""
    return [
        [separation_task(scene, scheme, grid, h, start) for h in grid.step_sizes]
        for start in range(len(grid.initial_values))
    ]


def separations(scene: Scene, scheme: str, grid: Grid, results: Results) -> list[SeparationResult]:
    """Those over a grid that were found, by initial value, then step size."""
    found = (results.get(task.key) for row in _rows(scene, scheme, grid) for task in row)
    return [r for r in found if isinstance(r, SeparationResult)]


def _own(scene: Scene) -> list[Grid]:
    return [scene.grid] if scene.grid and scene.grid.separate else []


def _beside(scene: Scene) -> list[Grid]:
    return [over.as_grid() for over in scene.separation]


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name = called(scene)
    for grid in (*_own(scene), *_beside(scene)):
        if preserves:
            why = "ΔJ ≡ 0 is proved: the truncation part is exactly 0"
            plan.leave_out(f"{name}: truncation separated from rounding for {scheme}", why)
            continue
        for row in _rows(scene, scheme, grid):
            for task in row:
                plan.need(task, f"{name}: truncation separated from rounding in Λ")


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    def over(grids: Sequence[Grid]) -> tuple[SeparationGrid, ...]:
        found = []
        for scheme in scene.schemes:
            for grid in grids:
                points = separations(scene, scheme, grid, results)
                width = len(grid.step_sizes)
                rows = [points[i : i + width] for i in range(0, len(points), width)]
                found += [as_grid(row) for row in rows]
        return tuple(found)

    return {"separations": over(_own(scene)), "crossovers": over(_beside(scene))}


_SECTION = Section(
    2,
    "truncation separated from rounding",
    "the scene has no [[separation]], and its [grid] does not say `separate = true`",
    lambda scene: [*_own(scene), *_beside(scene)],
)
STUDY = Study(4, (_SECTION,), need_of_scheme=_need, found=_found)
