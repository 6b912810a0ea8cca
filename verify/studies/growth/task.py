"""The task of the growth law of Λ on one orbit."""

from typing import Literal

from verify.execution.keeping import Keeper
from verify.execution.task import InitialValueTask
from verify.scenes.results.growth import AverageResult


class GrowthTask(InitialValueTask):
    """The growth law of Λ on one orbit, with the time average in it."""

    result = AverageResult
    imports = ("verify.studies.growth.prediction",)
    kind: Literal["growth"] = "growth"
    digits: int

    def compute(self, keeper: Keeper) -> AverageResult:
        from verify.studies.growth.prediction import average_of

        exact = self.exact_hamiltonian()
        return average_of(exact, self.scheme, q=self.q, p=self.p, digits=self.digits)
