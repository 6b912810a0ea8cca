"""The tasks of splitting Λ of one run, in n degrees of freedom W, into truncation and rounding."""

from fractions import Fraction
from typing import Any, ClassVar, Literal

from verify.arithmetic import AUTO, step_cost
from verify.arithmetic.systems import ball, float64
from verify.execution.keeping import Keeper
from verify.execution.task import StartTask, Task
from verify.lockstep import Course, run_alone
from verify.runs.run import RequestedRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results.separation import AnySeparation, SeparationInDegrees, SeparationResult
from verify.scenes.values import Number, StepSize
from verify.studies.separation.separate import separate_in_turn
from verify.studies.separation.ways.determinants import Determinants
from verify.studies.separation.ways.matrices import Matrices

DIGITS = 6  # of each part, in a scene


def serves_first_link(arithmetic: str, digits: int) -> bool:
    """Return True if a run in that arithmetic is certified to enough digits for the first link."""
    return arithmetic not in (float64.NAME, ball.NAME) and digits >= DIGITS + Determinants.cancelled


class SeparationTask(StartTask):
    """Split Λ of a float64 run into truncation and rounding."""

    result: ClassVar[type[AnySeparation]] = SeparationResult
    runs: ClassVar[int] = 3
    """The number of runs of the chain, in wide numbers."""
    points: ClassVar[int] = Determinants.points
    """Checkpoints, each of which costs about as much as `point_cost` float64 steps."""
    point_cost: ClassVar[int] = 80_000
    kind: Literal["separation", "separation in degrees"] = "separation"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    digits: int
    run: RunTask | None = None
    """A requested run of the same steps: its exact run is the separation's first link."""

    @property
    def cost(self) -> int:
        """About the number of float64 steps that its runs and their checkpoints are worth.

        A requested run is done in place of one of the chain's.
        """
        of_points = self.point_cost * min(self.steps, self.points)
        difference = 0 if self.run is None else self.run.cost - self.steps * step_cost(AUTO)
        return of_points + self.runs * self.steps * step_cost(AUTO) + difference

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

    def compute(self, keeper: Keeper) -> AnySeparation:
        """Return the separation as a result."""
        split: AnySeparation = run_alone(self._separate(keeper, self._requested_run(keeper)))
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

    result = SeparationInDegrees
    runs = 8  # of which those beside float64 are done twice and carry matrices
    points = Matrices.points
    point_cost = 400_000
    kind: Literal["separation in degrees"] = "separation in degrees"

    @property
    def ensemble(self) -> None:
        """None: no number system steps several of them together."""
        return None
