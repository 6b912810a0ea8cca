"""The task of one run."""

from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, in_lanes, step_cost
from verify.arithmetic.systems import float64, mpfr
from verify.execution.keeping import NOTHING, Keeper
from verify.execution.task import StartTask
from verify.kernels.run_inputs import SECTIONS
from verify.lockstep import Course, alone
from verify.runs.float64 import DIRECT_STEPS
from verify.runs.run import AskedRun
from verify.scenes.frozen import Frozen
from verify.scenes.results.run import RunResult
from verify.scenes.values import Number, StepSize

# About what a run costs however short, and one that is too long to be held against a certified one.
_RUN_COST, _LONG_RUN_COST = 1_000_000, 50_000_000


class RunTask(StartTask):
    """Run N steps and report the observables."""

    result = RunResult
    kind: Literal["run"] = "run"
    step_size: StepSize
    steps: int
    t0: Number = Fraction(0)
    arithmetic: str
    digits: int
    observables: tuple[str, ...] | None
    points: int
    sections: int = SECTIONS
    shares_kernel: bool = False

    @property
    def cost(self) -> int:
        """Steps times what a step in this arithmetic costs, beside what any run does.

        Short ones in float64 are held against another run, whose steps are what they cost.
        """
        if self.arithmetic != float64.NAME:
            return _RUN_COST + self.steps * step_cost(self.arithmetic)
        if self.steps <= DIRECT_STEPS:
            other = AUTO if self.shares_kernel else mpfr.NAME
            return _RUN_COST + self.steps * step_cost(other)
        return _LONG_RUN_COST + self.steps * step_cost(float64.NAME)

    @property
    def ensemble(self) -> str | None:
        """Runs of one kernel, where its number system steps several together."""
        if not in_lanes(self.arithmetic):
            return None
        series = "with" if self.points else "without"
        return f"{self.kind} {self.scheme} {self.hamiltonian} {self.arithmetic} {series} series"

    def proved(self) -> RunResult | None:
        """What a proof gives of the run without a step; None where it is not all that is asked."""
        return self.asked_run().proved()

    def asked_run(self, keeper: Keeper = NOTHING) -> AskedRun:
        """The run that `compute` does."""
        return AskedRun(self.exact_hamiltonian(), **self.asked(), keeper=keeper)

    def compute(self, keeper: Keeper) -> RunResult:
        """The run, from its last checkpoint where there is one."""
        return alone(self.asked_run(keeper).result())

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """The same."""
        return {self.key: (yield from self.asked_run(keeper).result())}
