"""Orbits looked at now and then: at multiples of a period of H, and where they pass a surface."""

from collections.abc import Iterator
from typing import Any

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
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


def _at_periods(scene: Scene, asked: Stroboscopic) -> Iterator[StroboscopicTask]:
    for scheme in asked.schemes or scene.schemes:
        yield StroboscopicTask(
            **scene.hamiltonian_fields(), scheme=scheme,
            initial_values=asked.initial_values, t0=scene.begin,
            step_size=asked.step_size, steps=asked.steps, periods=asked.periods,
            digits=asked.digits,
        )  # fmt: skip


def _at_surface(scene: Scene, asked: Poincare) -> Iterator[PoincareTask]:
    maps = asked.schemes or scene.schemes
    for name in (EXACT_FLOW, *maps) if asked.exact else maps:
        yield PoincareTask(
            **scene.hamiltonian_fields(), map=name,
            initial_values=asked.initial_values, coordinate=asked.coordinate, value=asked.value,
            rising=asked.rising, draw=asked.draw, step_size=asked.step_size, steps=asked.count,
            digits=asked.digits,
        )  # fmt: skip


def _need(plan: Plan, scene: Scene) -> None:
    name = called(scene)
    for strobed in scene.stroboscopic:
        for task in _at_periods(scene, strobed):
            plan.need(task, f"{name}: {task.scheme} at multiples of {text(strobed.period)}")
    for passed in scene.poincare:
        where = f"where {passed.coordinate} passes {text(passed.value)}"
        for by in _at_surface(scene, passed):
            plan.need(by, f"{name}: {by.map} {where}")


def _periods(scene: Scene, results: Results) -> Iterator[StroboscopicResult]:
    begin = None if scene.begin is None else text(scene.begin)
    for asked in scene.stroboscopic:
        sections = known_results(SchemeSections, _at_periods(scene, asked), results)
        if sections:
            yield StroboscopicResult(
                period=text(asked.period),
                step_size=text(asked.step_size),
                periods=asked.periods,
                t0=begin,
                q_is_angle=is_angle(scene.exact_hamiltonian()),
                sections=tuple(sections),
                source=asked.source,
            )


def _passes(scene: Scene, results: Results) -> Iterator[PoincareResult]:
    for asked in scene.poincare:
        sections = known_results(MapSections, _at_surface(scene, asked), results)
        if sections:
            yield PoincareResult(
                coordinate=asked.coordinate,
                value=text(asked.value),
                rising=asked.rising,
                draw=asked.draw,
                step_size=text(asked.step_size),
                steps=asked.count,
                time=text(asked.step_size * asked.count),
                sections=tuple(sections),
                source=asked.source,
            )


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    return {
        "stroboscopic": tuple(_periods(scene, results)),
        "poincare": tuple(_passes(scene, results)),
    }


def _asked_at_periods(scene: Scene) -> bool:
    """Also of an H without time, of which nobody asks it: nothing is then said of it."""
    return bool(scene.stroboscopic) or not scene.exact_hamiltonian().time_dependent


def _asked_at_surface(scene: Scene) -> bool:
    """Also of an H that has none, of which nobody asks it: nothing is then said of it."""
    exact = scene.exact_hamiltonian()
    return bool(scene.poincare) or exact.degrees < 2 or exact.time_dependent


_WITHOUT = "the scene has no "
_AT_PERIODS = "orbits at multiples of a period", f"{_WITHOUT}[[stroboscopic]]", _asked_at_periods
_AT_SURFACE = "orbits where they pass a surface", f"{_WITHOUT}[[poincare]]", _asked_at_surface
STUDY = Study(11, (Section(11, *_AT_PERIODS), Section(12, *_AT_SURFACE)), need=_need, found=_found)
