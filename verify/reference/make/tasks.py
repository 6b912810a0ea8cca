"""The tasks of reference data: an orbit and the exact flow, every number correctly rounded."""

from fractions import Fraction
from typing import Any, ClassVar, Literal

from verify.arithmetic import automatic
from verify.arithmetic.exact import text
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask, InitialValueTask
from verify.kernels.orbit import Orbit
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.values import Number, StepSize

ROW_COST = 1_000_000  # of a row of reference data, however few its steps
FLOW_ROW_COST = 10 * ROW_COST


class AtSteps(HamiltonianTask):
    """What is asked for from an initial value, after each of these numbers of steps."""

    imports = ("verify.reference.make.orbit_points",)
    q: Number
    p: Number
    t0: Number | None = None
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int

    @property
    def inputs(self) -> dict[str, Any]:
        """Step size, initial value, t₀ of an H in time, and digits, as the files have them."""
        exact = {"step_size": self.step_size, "q": self.q, "p": self.p, "t0": self.t0}
        told = {name: text(x) for name, x in exact.items() if x is not None}
        return {**told, "digits": self.digits}


class OrbitTask(AtSteps, InitialValueTask):
    """State, ΔJ, MSE and Λ after each of these numbers of steps, correctly rounded."""

    result = OrbitResult
    numbers: ClassVar[str] = "ΔJ, MSE and Λ"
    kind: Literal["orbit"] = "orbit"

    @property
    def cost(self) -> int:
        return ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    @property
    def ensemble(self) -> str | None:
        """Orbits of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    def compute(self, keeper: Keeper) -> OrbitResult:
        from verify.reference.make.orbit_points import orbit_points

        exact = self.exact_hamiltonian()
        orbit = Orbit(exact, self.scheme, self.step_size, self.q, self.p, t0=self.t0 or Fraction())
        return orbit_points(orbit, steps=self.steps, digits=self.digits)


class SolutionTask(AtSteps):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    result = SolutionResult
    kind: Literal["solution"] = "solution"

    @property
    def cost(self) -> int:
        return FLOW_ROW_COST * len(self.steps)

    def compute(self, keeper: Keeper) -> SolutionResult:
        from verify.reference.make.orbit_points import solution_points

        start = {"q": self.q, "p": self.p} | ({} if self.t0 is None else {"t0": self.t0})
        times = {n: n * self.step_size for n in self.steps}
        return solution_points(self.exact_hamiltonian(), start, times, self.digits)
