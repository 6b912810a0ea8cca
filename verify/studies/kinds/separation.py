"""Truncation separated from rounding in Λ: of the grid's runs, and over step sizes beside it.

In n degrees of freedom it is W that is split.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain, repeat
from typing import Any, ClassVar, Literal, NamedTuple

from verify.arithmetic import AUTO, step_cost
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, SceneQuestion, Study, results_of_tasks, scene_name
from verify.execution.task import StartTask, Task
from verify.lockstep import Course, run_alone
from verify.runs.requested_run import RequestedRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results import separation
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber, StepSize
from verify.structures import AREA, SYMPLECTIC
from verify.studies.kinds.grid import SEPARATION_DIGITS, grid_tasks, shares_runs
from verify.studies.separation.determinants import Determinants
from verify.studies.separation.matrix_products import Matrices
from verify.studies.separation.truncation_and_rounding import as_grid, separate_in_turn


class SeparationTask(StartTask):
    """Split Λ of a float64 run into truncation and rounding."""

    result: ClassVar[type[separation.AnySeparation]] = separation.SeparationResult
    runs: ClassVar[int] = 3
    """The number of runs of the chain, in wide numbers."""
    points: ClassVar[int] = Determinants.points
    """Checkpoints, each of which costs about as much as `point_cost` float64 steps."""
    point_cost: ClassVar[int] = 80_000
    kind: Literal["separation", "separation in degrees"] = "separation"
    step_size: StepSize
    steps: int
    t0: ExactNumber = Fraction(0)
    digits: int
    run: RunTask | None = None
    """A requested run of the same steps: its exact run is the separation's first link."""

    @property
    def cost(self) -> int:
        """About the number of float64 steps that its runs and their checkpoints are worth.

        A requested run is done in place of one of the chain's.
        """
        checkpoint_cost = self.point_cost * min(self.steps, self.points)
        difference = 0 if self.run is None else self.run.cost - self.steps * step_cost(AUTO)
        return checkpoint_cost + self.runs * self.steps * step_cost(AUTO) + difference

    @property
    def ensemble(self) -> str | None:
        """A key of the separations of one scheme's map, for any step size and initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    @property
    def gives(self) -> tuple[Task, ...]:
        """The requested run, whose result comes with the separation."""
        return () if self.run is None else (self.run,)

    def _separate(self, keeper: Keeper, run: RequestedRun | None) -> Course[Any]:
        arguments = self.other_fields("run")
        return separate_in_turn(self.exact_hamiltonian(), **arguments, run=run, keeper=keeper)

    def compute(self, keeper: Keeper) -> separation.AnySeparation:
        """Return the separation as a result."""
        split: separation.AnySeparation = run_alone(
            self._separate(keeper, self._requested_run(keeper))
        )
        return split

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """Return the separation, and the run where that was done for it."""
        run = self._requested_run(keeper)
        results: dict[str, Frozen] = {self.key: (yield from self._separate(keeper, run))}
        if self.run and run and run.done:
            results[self.run.key] = yield from run.result()
        return results

    def _requested_run(self, keeper: Keeper) -> RequestedRun | None:
        return self.run.requested_run(keeper) if self.run else None


class FormSeparationTask(SeparationTask):
    """Split W of a float64 run into truncation and rounding."""

    result = separation.SeparationInDegrees
    # More than the plane's three: the runs beside float64 are done twice and carry matrices.
    runs = 8
    points = Matrices.points
    point_cost = 400_000
    kind: Literal["separation in degrees"] = "separation in degrees"

    @property
    def ensemble(self) -> None:
        """None: no number system steps several of them together."""
        return None


class _SplitKind(NamedTuple):
    """The task of a split, and the keys of its results in a `SceneResult`.

    `own_key`: that of the scene's `[grid]`; `grid_key`: that of its `[[separation]]` sections.
    """

    task: type[SeparationTask]
    own_key: str
    grid_key: str


_SPLITS = {
    AREA: _SplitKind(SeparationTask, "separations", "crossovers"),
    SYMPLECTIC: _SplitKind(FormSeparationTask, "form_separations", "form_crossovers"),
}


def _rows(scene: Scene, scheme: str, grid: Grid) -> Sequence[Sequence[SeparationTask]]:
    """Return the splits of the grid's runs, by initial value, then step size."""
    common = scene.hamiltonian_fields()
    task = _SPLITS[scene.exact_hamiltonian().structure].task
    shares = grid is scene.grid and shares_runs(scene)
    runs: Iterator[dict[str, Any]] = repeat({})
    if shares:  # `grid_tasks` lists the runs in the order of the loops below
        runs = ({"run": run} for run in grid_tasks(scene, scheme))
    return [
        [
            task(
                **common, scheme=scheme, step_size=h, steps=grid.steps_for(h),
                **dict(initial_value), t0=scene.t0, digits=SEPARATION_DIGITS, **next(runs),
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
            reason = f"{structure.identity} is proved: the truncation part is exactly 0"
            plan.leave_out(f"{title} for {scheme}", reason)
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
            if (separations := results_of_tasks(separation.Separation, row, results))
        )
        for name, grids in (
            (split.own_key, _own_grids(scene)),
            (split.grid_key, _further_grids(scene)),
        )
    }


_SECTION = SceneQuestion(
    2,
    "truncation separated from rounding",
    "the scene has no [[separation]], and its [grid] does not say `separate = true`",
    lambda scene: [*_own_grids(scene), *_further_grids(scene)],
)
STUDY = Study(4, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
