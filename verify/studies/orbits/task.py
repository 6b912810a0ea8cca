"""The tasks of one map's orbits: at multiples of a period, and where they pass a surface."""

from typing import Literal

from verify.arithmetic import step_cost
from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask, SchemeTask
from verify.hamiltonians.start import point_of
from verify.scenes.results.orbit_sections import MapSections, SchemeSections
from verify.scenes.values import InitialValue, Number, Start, StepSize

_TIMES = 2  # each orbit is followed with many digits


class StroboscopicTask(SchemeTask):
    """Take states of orbits from these initial values every `steps` steps, `periods` times."""

    result = SchemeSections
    imports = ("verify.studies.orbits.at_periods",)
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
        from verify.studies.orbits.at_periods import sections_of

        common = {"h": self.step_size} | ({} if self.t0 is None else {"t": self.t0})
        starts = [
            {"p": initial_value.p, "q": initial_value.q} | common
            for initial_value in self.initial_values
        ]
        return sections_of(
            self.exact_hamiltonian(), self.scheme, starts,
            steps=self.steps, periods=self.periods, digits=self.digits,
        )  # fmt: skip


class PoincareTask(HamiltonianTask):
    """Find passes of `coordinate` = `value` within `steps` steps of a scheme or the exact flow."""

    result = MapSections
    imports = ("verify.studies.orbits.at_surface", "verify.studies.orbits.passes")
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
        from verify.studies.orbits.at_surface import SectionRequest, sections_of
        from verify.studies.orbits.passes import Surface

        exact = self.exact_hamiltonian()
        starts = [
            point_of(exact, initial_value.q, initial_value.p)
            for initial_value in self.initial_values
        ]
        surface = Surface(exact.coordinates, self.coordinate, self.value, self.rising)
        request = SectionRequest(exact, surface, self.draw, self.step_size, self.steps, self.digits)
        return sections_of(request, self.map, starts)
