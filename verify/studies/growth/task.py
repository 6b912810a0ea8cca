"""The task of the growth law of Λ on one orbit."""

from typing import Literal

from verify.execution.keeping import Keeper
from verify.execution.task import StartTask
from verify.scenes.results.growth import AverageResult

_COST = 25_000_000  # of its law and time average, about


class GrowthTask(StartTask):
    """The growth law of Λ on one orbit, with the time average in it."""

    result = AverageResult
    imports = ("verify.studies.growth.prediction",)
    kind: Literal["growth"] = "growth"
    digits: int

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> AverageResult:
        """The law, its average enclosed."""
        from verify.studies.growth.prediction import average_of

        return average_of(self.exact_hamiltonian(), **self.asked())
