"""The task of one run."""

from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, in_lanes, step_cost
from verify.arithmetic.systems import float64, mpfr
from verify.execution.keeper import NOTHING, Keeper
from verify.execution.task import SchemeTask
from verify.kernels.run_inputs import DEFAULT_SECTIONS
from verify.lockstep import Course, run_alone
from verify.runs.float64_bounds import DIRECT_STEPS
from verify.runs.requested_run import RequestedRun
from verify.scenes.frozen import Frozen
from verify.scenes.results.run import RunResult
from verify.scenes.values import Coordinates, ExactNumber, StepSize

# The cost of any run beside its steps, and that of a run too long to be compared with a certified
# one. Costs are in the unit of `step_cost`.
_RUN_COST, _LONG_RUN_COST = 1_000_000, 50_000_000


class RunTask(SchemeTask):
    """Run N steps, from q and p or of equations from `start`, and report the observables."""

    result = RunResult
    kind: Literal["run"] = "run"
    q: Coordinates | None = None
    p: Coordinates | None = None
    start: dict[str, ExactNumber] | None = None
    step_size: StepSize
    steps: int
    t0: ExactNumber = Fraction(0)
    arithmetic: str
    digits: int
    observables: tuple[str, ...] | None
    points: int
    sections: int = DEFAULT_SECTIONS
    shares_kernel: bool = False

    @property
    def cost(self) -> int:
        """The fixed cost of a run, plus the number of steps times the cost of one."""
        if self.arithmetic != float64.NAME:
            return _RUN_COST + self.steps * step_cost(self.arithmetic)
        # A short float64 run is compared with a certified one, whose steps cost far more.
        if self.steps <= DIRECT_STEPS:
            reference = AUTO if self.shares_kernel else mpfr.NAME
            return _RUN_COST + self.steps * step_cost(reference)
        return _LONG_RUN_COST + self.steps * step_cost(float64.NAME)

    @property
    def ensemble(self) -> str | None:
        """A key shared by the runs of one kernel, if its number system steps several together."""
        if not in_lanes(self.arithmetic):
            return None
        series = "with" if self.points else "without"
        return f"{self.kind} {self.scheme} {self.hamiltonian} {self.arithmetic} {series} series"

    def result_by_proof(self) -> RunResult | None:
        """Return the result that a proof gives without a step; None if it leaves requests open."""
        return self.requested_run().prove_result()

    def requested_run(self, keeper: Keeper = NOTHING) -> RequestedRun:
        """Return the run of this task."""
        return RequestedRun(self.exact_hamiltonian(), **self.other_fields(), keeper=keeper)

    def compute(self, keeper: Keeper) -> RunResult:
        """Do the run, from its last checkpoint if there is one."""
        return run_alone(self.requested_run(keeper).result())

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """Do the run in turn with others; see `verify.lockstep`."""
        return {self.key: (yield from self.requested_run(keeper).result())}
