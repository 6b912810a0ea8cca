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
        """About the number of float64 steps that it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> AverageResult:
        """Return the law, with its average enclosed."""
        from verify.studies.growth.prediction import compute_average

        return compute_average(self.exact_hamiltonian(), **self.other_fields())
