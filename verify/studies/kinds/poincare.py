"""Orbits where they pass a surface: Poincaré sections of an autonomous H."""

from collections.abc import Iterator

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.scenes.poincare_section import Poincare
from verify.scenes.results.poincare import MapSections, PoincareResult
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.scene import Scene
from verify.studies.poincare.task import PoincareTask


def _tasks(scene: Scene, asked: Poincare) -> Iterator[PoincareTask]:
    maps = asked.schemes or scene.schemes
    for name in (EXACT_FLOW, *maps) if asked.exact else maps:
        yield PoincareTask(
            **scene.hamiltonian_fields(), map=name,
            initial_values=asked.initial_values, coordinate=asked.coordinate, value=asked.value,
            rising=asked.rising, draw=asked.draw, step_size=asked.step_size, steps=asked.count,
            digits=asked.digits,
        )  # fmt: skip


def _need(plan: Plan, scene: Scene) -> None:
    for asked in scene.poincare:
        for task in _tasks(scene, asked):
            what = f"{task.map} where {asked.coordinate} passes {text(asked.value)}"
            plan.need(task, f"{called(scene)}: {what}")


def _found(scene: Scene, results: Results) -> Iterator[PoincareResult]:
    for asked in scene.poincare:
        sections = known_results(MapSections, _tasks(scene, asked), results)
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


def _asked(scene: Scene) -> bool:
    """Also of an H that has none, of which nobody asks it: nothing is then said of it."""
    exact = scene.exact_hamiltonian()
    return bool(scene.poincare) or exact.degrees < 2 or exact.time_dependent


_SECTION = Section(12, "orbits where they pass a surface", "the scene has no [[poincare]]", _asked)
STUDY = Study(
    12,
    (_SECTION,),
    need=_need,
    found=lambda scene, results: {"poincare": tuple(_found(scene, results))},
)
