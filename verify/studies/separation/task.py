"""The tasks of splitting Λ of one run, in n degrees of freedom W, into truncation and rounding."""

from fractions import Fraction
from typing import Any, ClassVar, Literal

from verify.arithmetic import AUTO, step_cost
from verify.arithmetic.systems import ball, float64
from verify.execution.keeping import Keeper
from verify.execution.task import StartTask, Task
from verify.lockstep import Course, alone
from verify.runs.run import AskedRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results.separation import AnySeparation, SeparationInDegrees, SeparationResult
from verify.scenes.values import Number, StepSize
from verify.studies.separation.separate import separate_in_turn
from verify.studies.separation.ways.determinants import Determinants
from verify.studies.separation.ways.matrices import Matrices

DIGITS = 6  # of each part, in a scene


def does_for_first_link(arithmetic: str, digits: int) -> bool:
    """Whether a run in that arithmetic is certified, and has digits enough for the first link."""
    return arithmetic not in (float64.NAME, ball.NAME) and digits >= DIGITS + Determinants.cancelled


class SeparationTask(StartTask):
    """Split Λ of a float64 run into truncation and rounding."""

    result: ClassVar[type[AnySeparation]] = SeparationResult
    runs: ClassVar[int] = 3
    """Of the chain, in wide numbers."""
    points: ClassVar[int] = Determinants.points
    """Checkpoints, each of which costs about as much as `point_cost` float64 steps."""
    point_cost: ClassVar[int] = 80_000
    kind: Literal["separation", "separation in degrees"] = "separation"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    digits: int
    run: RunTask | None = None
    """One that is wanted too, of the same steps: its exact run is the separation's first link."""

    @property
    def cost(self) -> int:
        """About how many float64 steps its runs and their checkpoints are worth; a run that is
        wanted too is done in place of one of the chain's."""
        of_points = self.point_cost * min(self.steps, self.points)
        spared = 0 if self.run is None else self.run.cost - self.steps * step_cost(AUTO)
        return of_points + self.runs * self.steps * step_cost(AUTO) + spared

    @property
    def ensemble(self) -> str | None:
        """Separations of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    @property
    def gives(self) -> tuple[Task, ...]:
        """The run."""
        return () if self.run is None else (self.run,)

    def _separated(self, keeper: Keeper, run: AskedRun | None) -> Course[Any]:
        asked = self.asked("run")
        return separate_in_turn(self.exact_hamiltonian(), **asked, run=run, keeper=keeper)

    def compute(self, keeper: Keeper) -> AnySeparation:
        """The separation, as a result."""
        split: AnySeparation = alone(self._separated(keeper, self._asked_run(keeper)))
        return split

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """The separation, and the run where that was done for it."""
        run = self._asked_run(keeper)
        results: dict[str, Frozen] = {self.key: (yield from self._separated(keeper, run))}
        if self.run and run and run.done:
            results[self.run.key] = yield from run.result()
        return results

    def _asked_run(self, keeper: Keeper) -> AskedRun | None:
        return self.run.asked_run(keeper) if self.run else None


class FormSeparationTask(SeparationTask):
    """Split W of a float64 run into truncation and rounding."""

    result = SeparationInDegrees
    runs = 8  # of which those beside float64 are done twice and carry matrices
    points = Matrices.points
    point_cost = 400_000
    kind: Literal["separation in degrees"] = "separation in degrees"

    @property
    def ensemble(self) -> None:
        """None: no number system steps several of them together."""
        return None
