"""The task of one scheme's orbits at multiples of a period."""

from typing import Literal

from verify.arithmetic import step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import SchemeTask
from verify.scenes.results.stroboscopic import SchemeSections
from verify.scenes.values import InitialValue, Number, StepSize

_TIMES = 2  # with many digits, beside float64


class StroboscopicTask(SchemeTask):
    """Orbits from these initial values, looked at every `steps` steps, `periods` times."""

    result = SchemeSections
    imports = ("verify.studies.stroboscopic.sections",)
    kind: Literal["stroboscopic"] = "stroboscopic"
    initial_values: tuple[InitialValue, ...]
    t0: Number | None
    step_size: StepSize
    steps: int
    periods: int
    digits: int

    @property
    def cost(self) -> int:
        return _TIMES * len(self.initial_values) * self.steps * self.periods * step_cost("mpfr")

    def compute(self, keeper: Keeper) -> SchemeSections:
        from verify.studies.stroboscopic.sections import sections_of

        common = {"h": self.step_size} | ({} if self.t0 is None else {"t": self.t0})
        starts = [{"p": at.p, "q": at.q} | common for at in self.initial_values]
        return sections_of(
            self.exact_hamiltonian(), self.scheme, starts,
            steps=self.steps, periods=self.periods, digits=self.digits,
        )  # fmt: skip
