"""What is asked → what is needed: tasks, each once, with reasons; and what is left out and why."""

from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, called, plan_of
from verify.kernels.step.computation import step_map_of
from verify.scenes.scene import Scene
from verify.studies.kinds import studies


def plan_scenes(scenes: list[Scene]) -> Plan:
    """The tasks of all scenes; a task that several ask for is done once."""
    return plan_of(scenes, _plan_scene)


def found_of(scene: Scene, results: Results) -> dict[str, Any]:
    """What the studies make of the results of the scene's tasks: a `SceneResult`'s parts."""
    found: dict[str, Any] = {}
    for study in studies():
        found |= study.found(scene, results) if study.found else {}
    return found


def _plan_scene(plan: Plan, scene: Scene) -> None:
    found = studies()
    for scheme in scene.schemes:
        preserved = step_map_of(scene.exact_hamiltonian(), scheme).preserves_area
        for study in found:
            if study.need_of_scheme:
                study.need_of_scheme(plan, scene, scheme, preserved)
    for study in found:
        if study.need:
            study.need(plan, scene)
    for section in sorted((x for study in found for x in study.sections), key=lambda x: x.place):
        if not section.asked(scene):
            plan.leave_out(f"{called(scene)}: {section.what}", section.why_not)
