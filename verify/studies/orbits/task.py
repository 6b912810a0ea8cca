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
    """Orbits from these initial values, looked at every `steps` steps, `periods` times."""

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
        starts = [{"p": at.p, "q": at.q} | common for at in self.initial_values]
        return sections_of(
            self.exact_hamiltonian(), self.scheme, starts,
            steps=self.steps, periods=self.periods, digits=self.digits,
        )  # fmt: skip


class PoincareTask(HamiltonianTask):
    """Passes of `coordinate` = `value` within `steps` steps of a map: a scheme's, or the exact
    flow's."""

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
        from verify.studies.orbits.at_surface import Asked, sections_of
        from verify.studies.orbits.passes import Surface

        exact = self.exact_hamiltonian()
        starts = [point_of(exact, at.q, at.p) for at in self.initial_values]
        surface = Surface(exact.coordinates, self.coordinate, self.value, self.rising)
        asked = Asked(exact, surface, self.draw, self.step_size, self.steps, self.digits)
        return sections_of(asked, self.map, starts)
