"""The task of splitting W of one run, in n degrees of freedom, into truncation and rounding."""

from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import StartTask
from verify.scenes.results.separation_in_degrees import SeparationInDegrees
from verify.scenes.values import Number, StepSize
from verify.studies.separation.form_run import POINTS
from verify.studies.separation.form_separate import separate_in_degrees

_RUNS = 8  # of wide numbers, of which those beside float64 are done twice and carry matrices
_CHECKPOINT_COST = 400_000  # of W and its parts at one of them, about


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
        checkpoints = min(self.steps, POINTS)
        return _CHECKPOINT_COST * checkpoints + _RUNS * self.steps * step_cost(AUTO)

    def compute(self, keeper: Keeper) -> SeparationInDegrees:
        """The separation, as a result."""
        return separate_in_degrees(self.exact_hamiltonian(), **self.asked(), keeper=keeper)
