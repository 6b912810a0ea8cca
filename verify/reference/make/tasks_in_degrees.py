"""The tasks of reference data in n degrees of freedom: an orbit, and the exact flow."""

from fractions import Fraction
from typing import Any, ClassVar, Literal

from verify.arithmetic import automatic
from verify.arithmetic.exact import text
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.start import point_of
from verify.reference.make.tasks import FLOW_ROW_COST, ROW_COST
from verify.scenes.results.reference_in_degrees import (
    OrbitInDegreesResult,
    SolutionInDegreesResult,
)
from verify.scenes.values import Number, Several, StepSize


class AtStepsInDegrees(HamiltonianTask):
    """What is asked for from an initial value, after each of these numbers of steps."""

    imports = ("verify.reference.make.points_in_degrees",)
    q: Several
    p: Several
    t0: Number | None = None
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int

    @property
    def inputs(self) -> dict[str, Any]:
        """Step size, initial value, t₀ or None, and digits, as the files have them."""
        return {
            "step_size": text(self.step_size),
            "q": tuple(map(text, self.q)),
            "p": tuple(map(text, self.p)),
            "t0": None if self.t0 is None else text(self.t0),
            "digits": self.digits,
        }

    @property
    def point(self) -> dict[str, Fraction]:
        """The coordinates at the start, by name."""
        return point_of(self.exact_hamiltonian(), self.q, self.p)


class OrbitInDegreesTask(AtStepsInDegrees):
    """State, H, S, W and Λ after each of these numbers of steps, correctly rounded."""

    result = OrbitInDegreesResult
    numbers: ClassVar[str] = "H, S, W and Λ"
    kind: Literal["orbit in degrees"] = "orbit in degrees"
    scheme: str

    @property
    def cost(self) -> int:
        return ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    def compute(self, keeper: Keeper) -> OrbitInDegreesResult:
        from verify.reference.make.points_in_degrees import OrbitInDegrees, orbit_points

        orbit = OrbitInDegrees(
            self.exact_hamiltonian(), self.scheme, self.step_size, self.q, self.p,
            self.t0 or Fraction(),
        )  # fmt: skip
        return OrbitInDegreesResult(points=tuple(orbit_points(orbit, self.steps, self.digits)))


class SolutionInDegreesTask(AtStepsInDegrees):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    result = SolutionInDegreesResult
    kind: Literal["solution in degrees"] = "solution in degrees"

    @property
    def cost(self) -> int:
        return FLOW_ROW_COST * len(self.steps)

    def compute(self, keeper: Keeper) -> SolutionInDegreesResult:
        from verify.reference.make.points_in_degrees import flow_points

        times = {n: n * self.step_size for n in self.steps}
        exact, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        points = flow_points(exact, self.point, t0, times, self.digits)
        return SolutionInDegreesResult(points=tuple(points))
