"""The tasks of stability: the verdict on one run, the largest step, and a map of verdicts."""

from fractions import Fraction
from typing import Literal

from verify.arithmetic import AUTO, step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import StartTask
from verify.hamiltonians.start import point_of
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.values import Number, StepSize

_RUN_COST = 40_000_000  # about what a run costs that is judged, however short
_BISECTION_COST = 3 * _RUN_COST
_CELL_COST = _RUN_COST // 8  # of a map, most of whose cells are judged by one short run
_MOTION_COST = 1_000_000  # of a unit of time of the exact motion in n degrees of freedom, at ω = 1

_STEPS_OF_A_CELL = 4  # for each of its steps: a neighbour's, and those with W


class _FromATime(StartTask):
    t0: Number | None = None
    """None where H does not depend on time."""


class StabilityTask(_FromATime):
    """Judge one run: is it stable, drifting or unstable, and what is to blame?"""

    result = StabilityResult
    imports = ("verify.studies.stability.results", "verify.studies.stability.trail")
    kind: Literal["stability"] = "stability"
    step_size: StepSize
    steps: int

    @property
    def cost(self) -> int:
        return _RUN_COST + self.steps * step_cost(AUTO)

    def compute(self, keeper: Keeper) -> StabilityResult:
        from verify.studies.stability.results import run_result
        from verify.studies.stability.trail import Run

        exact, t0 = self.exact_hamiltonian(), self.t0 or Fraction(0)
        state = tuple(point_of(exact, self.q, self.p).values())
        return run_result(Run(exact, self.scheme, self.step_size, state, self.steps, t0))


class LargestStepTask(_FromATime):
    """The largest step size with bounded motion until `time`."""

    result = LargestStepResult
    imports = ("verify.studies.stability.limits",)
    kind: Literal["largest_step"] = "largest_step"
    time: Number
    energy_error: Number | None = None
    symplectic_defect: Number | None = None

    @property
    def cost(self) -> int:
        return _BISECTION_COST

    def compute(self, keeper: Keeper) -> LargestStepResult:
        from verify.studies.stability.limits import largest_step

        return largest_step(self.exact_hamiltonian(), **self.other_fields())


class StabilityMapTask(_FromATime):
    """Verdicts over a parameter's values and step sizes."""

    result = StabilityMapResult
    imports = ("verify.studies.stability.limits",)
    kind: Literal["stability_map"] = "stability_map"
    parameter: str
    values: tuple[Number, ...]
    step_sizes: tuple[StepSize, ...]
    steps: int

    @property
    def cost(self) -> int:
        cells = _CELL_COST * len(self.values) * len(self.step_sizes)
        if isinstance(self.q, Fraction):
            return cells
        motion = int(_MOTION_COST * self.steps * max(self.step_sizes))
        return cells + motion * len(self.values)

    def compute(self, keeper: Keeper) -> StabilityMapResult:
        from verify.studies.stability.limits import stability_map

        return stability_map(self.exact_hamiltonian(), **self.other_fields())


class OrbitMapTask(_FromATime):
    """Classify orbits over two of their initial values."""

    result = OrbitMapResult
    imports = ("verify.studies.stability.orbit_map",)
    kind: Literal["orbit_map"] = "orbit_map"
    axes: tuple[str, str]
    across: tuple[Number, ...]
    upwards: tuple[Number, ...]
    step_size: StepSize
    steps: int
    beyond: Number

    @property
    def cost(self) -> int:
        cells = len(self.across) * len(self.upwards)
        return _RUN_COST + cells * self.steps * _STEPS_OF_A_CELL

    def compute(self, keeper: Keeper) -> OrbitMapResult:
        from verify.studies.stability.orbit_map import orbit_map

        return orbit_map(self.exact_hamiltonian(), **self.other_fields())
