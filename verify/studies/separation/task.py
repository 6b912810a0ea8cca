"""The task of splitting Λ of one run into truncation and rounding."""

from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import InitialValueTask
from verify.scenes.results.separation import SeparationResult
from verify.scenes.values import Number, StepSize
from verify.studies.separation.separate import separate
from verify.studies.separation.working import POINTS

_RUNS = 3  # of the chain, in wide numbers
_CHECKPOINT_COST = 80_000  # of Λ and its parts at one of them, about


class SeparationTask(InitialValueTask):
    """Split Λ of a float64 run into truncation and rounding."""

    result = SeparationResult
    kind: Literal["separation"] = "separation"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    digits: int

    @property
    def cost(self) -> int:
        """About how many float64 steps its runs and their checkpoints are worth."""
        checkpoints = min(self.steps, POINTS)
        return _CHECKPOINT_COST * checkpoints + _RUNS * self.steps * step_cost(AUTO)

    @property
    def ensemble(self) -> str | None:
        """Separations of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    def compute(self, keeper: Keeper) -> SeparationResult:
        """The separation, as a result."""
        return separate(self.exact_hamiltonian(), **self.asked(), keeper=keeper)
