"""The task of one map's orbits where they pass a surface."""

from typing import Literal

from verify.arithmetic import step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.start import point_of
from verify.scenes.results.poincare import MapSections
from verify.scenes.values import Number, Start, StepSize

_TIMES = 2  # each orbit is followed


class PoincareTask(HamiltonianTask):
    """Passes of `coordinate` = `value` within `steps` steps of a map: a scheme's, or the exact
    flow's."""

    result = MapSections
    imports = ("verify.studies.poincare.sections", "verify.studies.poincare.surface")
    kind: Literal["poincare"] = "poincare"
    map: str
    initial_values: tuple[Start, ...]
    coordinate: str
    value: Number
    rising: bool
    draw: tuple[str, str]
    step_size: StepSize
    steps: int
    digits: int

    @property
    def cost(self) -> int:
        return _TIMES * len(self.initial_values) * self.steps * step_cost("mpfr")

    def compute(self, keeper: Keeper) -> MapSections:
        from verify.studies.poincare.sections import Asked, sections_of
        from verify.studies.poincare.surface import Surface

        exact = self.exact_hamiltonian()
        starts = [point_of(exact, at.q, at.p) for at in self.initial_values]
        surface = Surface(exact.coordinates, self.coordinate, self.value, self.rising)
        asked = Asked(exact, surface, self.draw, self.step_size, self.steps, self.digits)
        return sections_of(asked, self.map, starts)
