"""The tasks of reference data: an orbit and the exact flow, every number correctly rounded."""

from typing import Literal

from verify.arithmetic import automatic
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask, InitialValueTask
from verify.kernels.orbit import Orbit
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.values import Number, StepSize

_ROW_COST = 1_000_000  # of a row of reference data, however few its steps
_FLOW_ROW_COST = 10 * _ROW_COST


class OrbitTask(InitialValueTask):
    """State, ΔJ, MSE and Λ after each of these numbers of steps, correctly rounded."""

    result = OrbitResult
    imports = ("verify.reference.make.orbit_points",)
    kind: Literal["orbit"] = "orbit"
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int

    @property
    def cost(self) -> int:
        return _ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    def compute(self, keeper: Keeper) -> OrbitResult:
        from verify.reference.make.orbit_points import orbit_points

        exact = self.exact_hamiltonian()
        orbit = Orbit(exact, self.scheme, self.step_size, self.q, self.p)
        return orbit_points(orbit, steps=self.steps, digits=self.digits)


class SolutionTask(HamiltonianTask):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    result = SolutionResult
    imports = ("verify.reference.make.orbit_points",)
    kind: Literal["solution"] = "solution"
    q: Number
    p: Number
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int

    @property
    def cost(self) -> int:
        return _FLOW_ROW_COST * len(self.steps)

    def compute(self, keeper: Keeper) -> SolutionResult:
        from verify.reference.make.orbit_points import solution_points

        return solution_points(
            self.exact_hamiltonian(),
            q=self.q,
            p=self.p,
            step_size=self.step_size,
            steps=self.steps,
            digits=self.digits,
        )
