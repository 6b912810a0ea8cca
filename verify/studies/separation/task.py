"""The tasks of splitting Λ of one run, in n degrees of freedom W, into truncation and rounding."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, step_cost
from verify.arithmetic.systems import ball, float64
from verify.execution.keeping import Keeper
from verify.execution.task import InitialValueTask, StartTask, Task
from verify.runs.run import AskedRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.separation_in_degrees import SeparationInDegrees
from verify.scenes.values import Number, StepSize
from verify.studies.separation.chain import CANCELLED
from verify.studies.separation.form_run import POINTS as POINTS_OF_FORM
from verify.studies.separation.form_separate import separate_in_degrees
from verify.studies.separation.separate import separate
from verify.studies.separation.working import POINTS

DIGITS = 6  # of each part, in a scene
_RUNS = 3  # of the chain, in wide numbers
_CHECKPOINT_COST = 80_000  # of Λ and its parts at one of them, about
_RUNS_OF_FORM = 8  # of which those beside float64 are done twice and carry matrices
_CHECKPOINT_COST_OF_FORM = 400_000  # of W and its parts


def does_for_first_link(arithmetic: str, digits: int) -> bool:
    """Whether a run in that arithmetic is certified, and has digits enough for the first link."""
    return arithmetic not in (float64.NAME, ball.NAME) and digits >= DIGITS + CANCELLED


class SeparationTask(InitialValueTask):
    """Split Λ of a float64 run into truncation and rounding."""

    result = SeparationResult
    kind: Literal["separation"] = "separation"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    digits: int
    run: RunTask | None = None
    """One that is wanted too, of the same steps: its exact run is the separation's first link."""

    @property
    def cost(self) -> int:
        """About how many float64 steps its runs and their checkpoints are worth."""
        own = _CHECKPOINT_COST * min(self.steps, POINTS)
        if self.run is None:
            return own + _RUNS * self.steps * step_cost(AUTO)
        return own + self.run.cost + (_RUNS - 1) * self.steps * step_cost(AUTO)

    @property
    def ensemble(self) -> str | None:
        """Separations of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    @property
    def gives(self) -> tuple[Task, ...]:
        """The run."""
        return () if self.run is None else (self.run,)

    def compute(self, keeper: Keeper) -> SeparationResult:
        """The separation, as a result."""
        return self._separated(keeper, self.run.asked_run(keeper) if self.run else None)

    def computed(self, keeper: Keeper) -> Iterator[tuple[Task, Frozen]]:
        """The separation, and the run where that was done for it."""
        own = self.run.asked_run(keeper) if self.run else None
        yield self, self._separated(keeper, own)
        if self.run and own and own.done:
            yield self.run, own.result()

    def _separated(self, keeper: Keeper, own: AskedRun | None) -> SeparationResult:
        return separate(self.exact_hamiltonian(), **self.asked("run"), run=own, keeper=keeper)


class FormSeparationTask(StartTask):
    """Split W of a float64 run into truncation and rounding."""

    result = SeparationInDegrees
    kind: Literal["separation in degrees"] = "separation in degrees"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    digits: int

    @property
    def cost(self) -> int:
        """About how many float64 steps its runs and their checkpoints are worth."""
        checkpoints = min(self.steps, POINTS_OF_FORM)
        own = _CHECKPOINT_COST_OF_FORM * checkpoints
        return own + _RUNS_OF_FORM * self.steps * step_cost(AUTO)

    def compute(self, keeper: Keeper) -> SeparationInDegrees:
        """The separation, as a result."""
        return separate_in_degrees(self.exact_hamiltonian(), **self.asked(), keeper=keeper)
