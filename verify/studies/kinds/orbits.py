"""Sections of orbits: their states at multiples of a period of H, and where they pass a surface."""

from collections.abc import Iterator
from typing import Any

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, results_of_tasks, scene_name
from verify.hamiltonians.periods import is_angle
from verify.scenes.orbit_sections import Poincare, Stroboscopic
from verify.scenes.results.orbit_sections import (
    MapSections,
    PoincareResult,
    SchemeSections,
    StroboscopicResult,
)
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.scene import Scene
from verify.studies.orbits.task import PoincareTask, StroboscopicTask


def _period_tasks(scene: Scene, section: Stroboscopic) -> Iterator[StroboscopicTask]:
    for scheme in section.schemes or scene.schemes:
        yield StroboscopicTask(
            **scene.hamiltonian_fields(), scheme=scheme,
            initial_values=section.initial_values, t0=scene.begin,
            step_size=section.step_size, steps=section.steps, periods=section.periods,
            digits=section.digits,
        )  # fmt: skip


def _surface_tasks(scene: Scene, section: Poincare) -> Iterator[PoincareTask]:
    maps = section.schemes or scene.schemes
    for name in (EXACT_FLOW, *maps) if section.exact else maps:
        yield PoincareTask(
            **scene.hamiltonian_fields(), map=name,
            initial_values=section.initial_values, coordinate=section.coordinate,
            value=section.value, rising=section.rising, draw=section.draw,
            step_size=section.step_size, steps=section.count, digits=section.digits,
        )  # fmt: skip


def _need(plan: Plan, scene: Scene) -> None:
    name = scene_name(scene)
    for section in scene.stroboscopic:
        for task in _period_tasks(scene, section):
            plan.need(task, f"{name}: {task.scheme} at multiples of {text(section.period)}")
    for surface in scene.poincare:
        where = f"where {surface.coordinate} passes {text(surface.value)}"
        for by in _surface_tasks(scene, surface):
            plan.need(by, f"{name}: {by.map} {where}")


def _period_results(scene: Scene, results: Results) -> Iterator[StroboscopicResult]:
    begin = None if scene.begin is None else text(scene.begin)
    for section in scene.stroboscopic:
        sections = results_of_tasks(SchemeSections, _period_tasks(scene, section), results)
        if sections:
            yield StroboscopicResult(
                period=text(section.period),
                step_size=text(section.step_size),
                periods=section.periods,
                t0=begin,
                q_is_angle=is_angle(scene.exact_hamiltonian()),
                sections=tuple(sections),
                source=section.source,
            )


def _surface_results(scene: Scene, results: Results) -> Iterator[PoincareResult]:
    for section in scene.poincare:
        sections = results_of_tasks(MapSections, _surface_tasks(scene, section), results)
        if sections:
            yield PoincareResult(
                coordinate=section.coordinate,
                value=text(section.value),
                rising=section.rising,
                draw=section.draw,
                step_size=text(section.step_size),
                steps=section.count,
                time=text(section.step_size * section.count),
                sections=tuple(sections),
                source=section.source,
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
    exact = scene.exact_hamiltonian()
    return bool(scene.poincare) or exact.degrees < 2 or exact.time_dependent


_WITHOUT = "the scene has no "
_AT_PERIODS = (
    "orbits at multiples of a period",
    f"{_WITHOUT}[[stroboscopic]]",
    _has_period_sections,
)
_AT_SURFACE = "orbits where they pass a surface", f"{_WITHOUT}[[poincare]]", _has_surface_sections
STUDY = Study(
    11,
    (Section(11, *_AT_PERIODS), Section(12, *_AT_SURFACE)),
    need=_need,
    results_for_scene=_collect,
)
