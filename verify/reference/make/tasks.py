"""The tasks of reference data: an orbit and the exact flow, every number correctly rounded."""

from fractions import Fraction
from typing import Any, Literal

from verify.arithmetic import automatic
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.start import point_of
from verify.lockstep import Course, run_alone
from verify.runs.start import Start
from verify.scenes.frozen import Frozen
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.values import Coordinates, Number, StepSize

ROW_COST = 1_000_000  # of a row of reference data, however few its steps
FLOW_ROW_COST = 10 * ROW_COST


class StepsTask(HamiltonianTask):
    """A request for numbers from an initial value, after each of these numbers of steps."""

    imports = ("verify.reference.make.orbit_points",)
    step_size: StepSize
    q: Coordinates
    p: Coordinates
    t0: Number | None = None
    digits: int
    steps: tuple[int, ...]

    @property
    def inputs(self) -> dict[str, Any]:
        """Step size, initial value, t₀ and digits, as the files have them: in several degrees of
        freedom they have lists, and a t₀ of every H."""
        names = {"step_size", "q", "p", "t0", "digits"}
        if isinstance(self.q, Fraction) and self.t0 is None:
            names.remove("t0")
        return self.model_dump(include=names)


class OrbitTask(StepsTask):
    """A scheme's orbit after each of these numbers of steps, correctly rounded."""

    result = OrbitResult
    kind: Literal["orbit"] = "orbit"
    scheme: str

    @property
    def cost(self) -> int:
        return ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    @property
    def ensemble(self) -> str | None:
        """Orbits of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    @property
    def orbit(self) -> Start:
        """The orbit of which these are points."""
        exact, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        point = point_of(exact, self.q, self.p)
        return Start(exact, self.scheme, self.step_size, point, t0)

    def compute(self, keeper: Keeper) -> OrbitResult:
        from verify.reference.make.orbit_points import orbit_points

        return OrbitResult(points=run_alone(orbit_points(self.orbit, self.steps, self.digits)))

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        from verify.reference.make.orbit_points import orbit_points

        points = yield from orbit_points(self.orbit, self.steps, self.digits)
        return {self.key: OrbitResult(points=points)}


class SolutionTask(StepsTask):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    result = SolutionResult
    kind: Literal["solution"] = "solution"

    @property
    def cost(self) -> int:
        return FLOW_ROW_COST * len(self.steps)

    def compute(self, keeper: Keeper) -> SolutionResult:
        from verify.reference.make.orbit_points import solution_points

        exact, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        start, times = point_of(exact, self.q, self.p), {n: n * self.step_size for n in self.steps}
        points = solution_points(exact, start, t0, times, self.digits)
        return SolutionResult(points=tuple(points))
