"""A scene's sections on stability → the tasks that they need."""

from collections.abc import Iterator, Sequence
from typing import Any, TypeVar

from verify.arithmetic.exact import short
from verify.execution.plan import Plan
from verify.execution.study import called
from verify.scenes.scene import Scene
from verify.scenes.stability_sections import LargestStepOver, OrbitMap, StabilityMap
from verify.studies.stability.task import (
    LargestStepTask,
    OrbitMapTask,
    StabilityMapTask,
    StabilityTask,
)

Asked = TypeVar("Asked", LargestStepOver, StabilityMap, OrbitMap)


def need_stability(plan: Plan, scene: Scene) -> None:
    """Adds what the scene asks for of stability."""
    name = called(scene)
    for run, judged in stability_tasks(scene):
        plan.need(judged, f"{run}: is it stable, and whose fault is it if not")
    for largest in largest_step_tasks(scene):
        plan.need(largest, f"{name}: the largest step with bounded motion")
    for over in stability_map_tasks(scene):
        plan.need(over, f"{name}: stability over step size and {over.parameter}")
    for over_starts in orbit_map_tasks(scene):
        plan.need(over_starts, f"{name}: orbits over {' and '.join(over_starts.axes)}")


def _given(scene: Scene) -> dict[str, Any]:
    """H, and when its runs start where it depends on time."""
    timed = scene.exact_hamiltonian().time_dependent
    return scene.hamiltonian_fields() | ({"t0": scene.t0} if timed else {})


def stability_tasks(scene: Scene) -> Iterator[tuple[str, StabilityTask]]:
    """Each run with its name: scene, section, scheme, step size and which initial value."""
    given = _given(scene) if scene.stability else {}
    for section in scene.stability:
        for scheme in section.schemes or scene.schemes:
            for k, at in enumerate(section.initial_values, start=1):
                for h in section.step_sizes:
                    parts = [scene.name or "scene", section.name, scheme, f"h={short(h)}"]
                    if len(section.initial_values) > 1:
                        parts.append(f"z0 no. {k}")
                    steps = section.steps_for(h)
                    task = StabilityTask(
                        **given, scheme=scheme, step_size=h, steps=steps, q=at.q, p=at.p
                    )
                    yield "/".join(filter(None, parts)), task


def _of_schemes(scene: Scene, sections: Sequence[Asked]) -> Iterator[tuple[Asked, dict[str, Any]]]:
    """Each section with each of its schemes, and what its task begins with."""
    given = _given(scene) if sections else {}
    for section in sections:
        start = {"q": section.initial_value.q, "p": section.initial_value.p}
        for scheme in section.schemes or scene.schemes:
            yield section, {**given, "scheme": scheme, **start}


def largest_step_tasks(scene: Scene) -> Iterator[LargestStepTask]:
    for section, begun in _of_schemes(scene, scene.largest_step):
        yield LargestStepTask(
            **begun, time=section.time, energy_error=section.energy_error,
            symplectic_defect=section.symplectic_defect,
        )  # fmt: skip


def stability_map_tasks(scene: Scene) -> Iterator[StabilityMapTask]:
    for section, begun in _of_schemes(scene, scene.stability_map):
        yield StabilityMapTask(
            **begun, parameter=section.parameter, values=section.values,
            step_sizes=section.step_sizes, steps=section.steps,
        )  # fmt: skip


def orbit_map_tasks(scene: Scene) -> Iterator[OrbitMapTask]:
    for section, begun in _of_schemes(scene, scene.orbit_map):
        yield OrbitMapTask(
            **begun, axes=section.axes, across=section.across, upwards=section.upwards,
            step_size=section.step_size, steps=section.count,
            beyond=section.farthest(scene.exact_hamiltonian()),
        )  # fmt: skip
