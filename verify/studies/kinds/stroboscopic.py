"""Orbits at multiples of a period of H."""

from collections.abc import Iterator

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.hamiltonians.periods import is_angle
from verify.scenes.results.stroboscopic import SchemeSections, StroboscopicResult
from verify.scenes.scene import Scene
from verify.scenes.stroboscopic_section import Stroboscopic
from verify.studies.stroboscopic.task import StroboscopicTask


def _tasks(scene: Scene, asked: Stroboscopic) -> Iterator[StroboscopicTask]:
    timed = scene.exact_hamiltonian().time_dependent
    for scheme in asked.schemes or scene.schemes:
        yield StroboscopicTask(
            **scene.hamiltonian_fields(), scheme=scheme,
            initial_values=asked.initial_values, t0=scene.t0 if timed else None,
            step_size=asked.step_size, steps=asked.steps, periods=asked.periods,
            digits=asked.digits,
        )  # fmt: skip


def _need(plan: Plan, scene: Scene) -> None:
    for asked in scene.stroboscopic:
        for task in _tasks(scene, asked):
            what = f"{task.scheme} at multiples of {text(asked.period)}"
            plan.need(task, f"{called(scene)}: {what}")


def _found(scene: Scene, results: Results) -> Iterator[StroboscopicResult]:
    exact = scene.exact_hamiltonian()
    for asked in scene.stroboscopic:
        sections = known_results(SchemeSections, _tasks(scene, asked), results)
        if sections:
            yield StroboscopicResult(
                period=text(asked.period),
                step_size=text(asked.step_size),
                periods=asked.periods,
                t0=text(scene.t0) if exact.time_dependent else None,
                q_is_angle=is_angle(exact),
                sections=tuple(sections),
                source=asked.source,
            )


def _asked(scene: Scene) -> bool:
    """Also of an H without time, of which nobody asks it: nothing is then said of it."""
    return bool(scene.stroboscopic) or not scene.exact_hamiltonian().time_dependent


_WHY_NOT = "the scene has no [[stroboscopic]]"
_SECTION = Section(11, "orbits at multiples of a period", _WHY_NOT, _asked)
STUDY = Study(
    11,
    (_SECTION,),
    need=_need,
    found=lambda scene, results: {"stroboscopic": tuple(_found(scene, results))},
)
