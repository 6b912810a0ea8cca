"""Sections of orbits: their states at multiples of a period of H, and where they pass a surface."""

from collections.abc import Iterator
from typing import Any, Literal

from verify.arithmetic import step_cost
from verify.arithmetic.exact import text
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, SceneQuestion, Study, results_of_tasks, scene_name
from verify.execution.task import HamiltonianTask, SchemeTask
from verify.hamiltonians.periods import is_angle
from verify.hamiltonians.run_domain import point_of
from verify.scenes.orbit_sections import Poincare, Stroboscopic
from verify.scenes.results.orbit_points import (
    MapSections,
    PoincareResult,
    SchemeSections,
    StroboscopicResult,
)
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber, InitialValue, Start, StepSize

_TIMES = 2  # each orbit is followed with many digits


class StroboscopicTask(SchemeTask):
    """Take states of orbits from these initial values every `steps` steps, `periods` times."""

    result = SchemeSections
    imports = ("verify.studies.section_points",)
    kind: Literal["stroboscopic"] = "stroboscopic"
    initial_values: tuple[InitialValue, ...]
    t0: ExactNumber | None
    step_size: StepSize
    steps: int
    periods: int
    digits: int

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        return _TIMES * len(self.initial_values) * self.steps * self.periods * step_cost("mpfr")

    def compute(self, keeper: Keeper) -> SchemeSections:
        """Return the orbits' states once in each period."""
        from verify.studies.section_points import sections_at_periods

        common = {"h": self.step_size} | ({} if self.t0 is None else {"t": self.t0})
        starts = [
            {"p": initial_value.p, "q": initial_value.q} | common
            for initial_value in self.initial_values
        ]
        return sections_at_periods(
            self.exact_hamiltonian(), self.scheme, starts,
            steps=self.steps, periods=self.periods, digits=self.digits,
        )  # fmt: skip


class PoincareTask(HamiltonianTask):
    """Find passes of `coordinate` = `value` within `steps` steps of a scheme or the exact flow."""

    result = MapSections
    imports = ("verify.studies.section_points", "verify.studies.surface_passes")
    kind: Literal["poincare"] = "poincare"
    map: str
    initial_values: tuple[Start, ...]
    coordinate: str
    value: ExactNumber
    rising: bool
    draw: tuple[str, str]
    step_size: StepSize
    steps: int
    digits: int

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        return _TIMES * len(self.initial_values) * self.steps * step_cost("mpfr")

    def compute(self, keeper: Keeper) -> MapSections:
        """Return the orbits' passes."""
        from verify.studies.section_points import SectionRequest, sections_at_surface
        from verify.studies.surface_passes import Surface

        hamiltonian = self.exact_hamiltonian()
        starts = [
            point_of(hamiltonian, initial_value.q, initial_value.p)
            for initial_value in self.initial_values
        ]
        surface = Surface(hamiltonian.coordinates, self.coordinate, self.value, self.rising)
        request = SectionRequest(
            hamiltonian, surface, self.draw, self.step_size, self.steps, self.digits
        )
        return sections_at_surface(request, self.map, starts)


def _period_tasks(scene: Scene, section: Stroboscopic) -> Iterator[StroboscopicTask]:
    for scheme in section.schemes or scene.schemes:
        fields = scene.hamiltonian_fields() | {"scheme": scheme, "t0": scene.begin}
        yield StroboscopicTask.from_object(section, **fields)


def _surface_tasks(scene: Scene, section: Poincare) -> Iterator[PoincareTask]:
    maps = section.schemes or scene.schemes
    for name in (EXACT_FLOW, *maps) if section.exact else maps:
        fields = scene.hamiltonian_fields() | {"map": name, "steps": section.count}
        yield PoincareTask.from_object(section, **fields)


def _need(plan: Plan, scene: Scene) -> None:
    name = scene_name(scene)
    for section in scene.stroboscopic:
        for task in _period_tasks(scene, section):
            plan.need(task, f"{name}: {task.scheme} at multiples of {text(section.period)}")
    for surface in scene.poincare:
        pass_text = f"where {surface.coordinate} passes {text(surface.value)}"
        for surface_task in _surface_tasks(scene, surface):
            plan.need(surface_task, f"{name}: {surface_task.map} {pass_text}")


def _period_results(scene: Scene, results: Results) -> Iterator[StroboscopicResult]:
    begin = None if scene.begin is None else text(scene.begin)
    for section in scene.stroboscopic:
        sections = results_of_tasks(SchemeSections, _period_tasks(scene, section), results)
        if sections:
            yield StroboscopicResult.from_object(
                section,
                period=text(section.period),
                step_size=text(section.step_size),
                t0=begin,
                q_is_angle=is_angle(scene.exact_hamiltonian()),
                sections=tuple(sections),
            )


def _surface_results(scene: Scene, results: Results) -> Iterator[PoincareResult]:
    for section in scene.poincare:
        sections = results_of_tasks(MapSections, _surface_tasks(scene, section), results)
        if sections:
            yield PoincareResult.from_object(
                section,
                value=text(section.value),
                step_size=text(section.step_size),
                steps=section.count,
                time=text(section.step_size * section.count),
                sections=tuple(sections),
            )


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    return {
        "stroboscopic": tuple(_period_results(scene, results)),
        "poincare": tuple(_surface_results(scene, results)),
    }


def _has_period_sections(scene: Scene) -> bool:
    """Return True if the scene has stroboscopic sections, or H does not depend on t."""
    return bool(scene.stroboscopic) or not scene.exact_hamiltonian().time_dependent


def _has_surface_sections(scene: Scene) -> bool:
    """Return True if the scene has Poincaré sections, or an H that has no surface of its own."""
    hamiltonian = scene.exact_hamiltonian()
    return bool(scene.poincare) or hamiltonian.degrees < 2 or hamiltonian.time_dependent


_WITHOUT = "the scene has no "
_AT_PERIODS = (
    "orbits at multiples of a period",
    f"{_WITHOUT}[[stroboscopic]]",
    _has_period_sections,
)
_AT_SURFACE = "orbits where they pass a surface", f"{_WITHOUT}[[poincare]]", _has_surface_sections
STUDY = Study(
    11,
    (SceneQuestion(11, *_AT_PERIODS), SceneQuestion(12, *_AT_SURFACE)),
    need=_need,
    results_for_scene=_collect,
)
