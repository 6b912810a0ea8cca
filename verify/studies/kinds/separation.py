"""Truncation separated from rounding in Λ: of the grid's runs, and over step sizes beside it."""

from collections.abc import Sequence
from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.scenes.results.separation import SeparationGrid, SeparationResult
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.studies.separation.separate import as_grid
from verify.studies.separation.task import SeparationTask

_DIGITS = 6  # of each part


def _rows(scene: Scene, scheme: str, grid: Grid) -> list[list[SeparationTask]]:
    """The splits of the grid's runs, by initial value, then step size."""
    given = scene.hamiltonian_fields()
    return [
        [
            SeparationTask(
                **given, scheme=scheme, step_size=h, steps=grid.steps_for(h),
                q=at.q, p=at.p, t0=scene.t0, digits=_DIGITS,
            )
            for h in grid.step_sizes
        ]
        for at in grid.in_the_plane
    ]  # fmt: skip


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
        rows = (
            known_results(SeparationResult, row, results)
            for scheme in scene.schemes
            for grid in grids
            for row in _rows(scene, scheme, grid)
        )
        return tuple(as_grid(row) for row in rows if row)

    return {"separations": over(_own(scene)), "crossovers": over(_beside(scene))}


_SECTION = Section(
    2,
    "truncation separated from rounding",
    "the scene has no [[separation]], and its [grid] does not say `separate = true`",
    lambda scene: [*_own(scene), *_beside(scene)],
)
STUDY = Study(4, (_SECTION,), need_of_scheme=_need, found=_found)
