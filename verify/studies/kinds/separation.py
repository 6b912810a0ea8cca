"""Truncation separated from rounding in Λ: of the grid's runs, and over step sizes beside it.

In n degrees of freedom it is W that is split.
"""

from collections.abc import Iterator, Sequence
from itertools import chain, repeat
from typing import Any, NamedTuple

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.scenes.results.separation import Separation
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.kinds.grid import grid_tasks, shares_runs
from verify.studies.separation.separate import as_grid
from verify.studies.separation.task import DIGITS, FormSeparationTask, SeparationTask


class _Split(NamedTuple):
    """What is computed, and where a `SceneResult` has it: of the grid's runs, and beside them."""

    task: type[SeparationTask]
    own: str
    beside: str


_SPLITS = {
    AREA: _Split(SeparationTask, "separations", "crossovers"),
    SYMPLECTIC: _Split(FormSeparationTask, "form_separations", "form_crossovers"),
}


def _rows(scene: Scene, scheme: str, grid: Grid) -> Sequence[Sequence[SeparationTask]]:
    """The splits of the grid's runs, by initial value, then step size."""
    given = scene.hamiltonian_fields()
    task = _SPLITS[scene.exact_hamiltonian().structure].task
    shared = grid is scene.grid and shares_runs(scene)
    runs: Iterator[dict[str, Any]] = repeat({})
    if shared:  # they are in the same order
        runs = ({"run": run} for run in grid_tasks(scene, scheme))
    return [
        [
            task(
                **given, scheme=scheme, step_size=h, steps=grid.steps_for(h),
                **dict(at), t0=scene.t0, digits=DIGITS, **next(runs),
            )
            for h in grid.step_sizes
        ]
        for at in grid.initial_values
    ]  # fmt: skip


def _own(scene: Scene) -> list[Grid]:
    return [scene.grid] if scene.grid and scene.grid.separate else []


def _beside(scene: Scene) -> list[Grid]:
    return [over.as_grid() for over in scene.separation]


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    structure = scene.exact_hamiltonian().structure
    title = f"{called(scene)}: truncation separated from rounding"
    for grid in (*_own(scene), *_beside(scene)):
        if preserves:
            without = f"{structure.identity} is proved: the truncation part is exactly 0"
            plan.leave_out(f"{title} for {scheme}", without)
            continue
        for task in chain.from_iterable(_rows(scene, scheme, grid)):
            plan.need(task, f"{title} in {structure.accumulated}")


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    split = _SPLITS[scene.exact_hamiltonian().structure]
    return {
        name: tuple(
            as_grid(known)
            for scheme in scene.schemes
            for grid in grids
            for row in _rows(scene, scheme, grid)
            if (known := known_results(Separation, row, results))
        )
        for name, grids in ((split.own, _own(scene)), (split.beside, _beside(scene)))
    }


_SECTION = Section(
    2,
    "truncation separated from rounding",
    "the scene has no [[separation]], and its [grid] does not say `separate = true`",
    lambda scene: [*_own(scene), *_beside(scene)],
)
STUDY = Study(4, (_SECTION,), need_of_scheme=_need, found=_found)
