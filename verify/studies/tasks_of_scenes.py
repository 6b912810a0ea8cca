"""The plan of some scenes: the tasks they need, each once, with reasons, and what is left out."""

from typing import Any

from verify.execution.plan import Plan, Results, Study, plan_of, scene_name
from verify.kernels.step.computation import step_map_of
from verify.scenes.scene import Scene
from verify.studies.kinds import studies


def plan_scenes(scenes: list[Scene]) -> Plan:
    """Plan the tasks of all scenes; a task that several scenes request is done once.

    The plan lists, each with its reason, the tasks that a proof makes needless and the sections
    that a scene does not request.
    """
    return plan_of(scenes, _plan_scene)


def collect_findings(scene: Scene, results: Results) -> dict[str, Any]:
    """Return the studies' parts of a `SceneResult`, from the results of the scene's tasks."""
    parts: dict[str, Any] = {}
    for study in _studies_of(scene):
        parts |= study.results_for_scene(scene, results) if study.results_for_scene else {}
    return parts


def _studies_of(scene: Scene) -> list[Study]:
    return [study for study in studies() if scene.field is None or study.takes_field]


def _plan_scene(plan: Plan, scene: Scene) -> None:
    every_study = _studies_of(scene)
    for scheme in scene.schemes:
        # Proved once for each scheme: every study needs it.
        preserves_area = step_map_of(scene.exact_hamiltonian(), scheme).preserves_area
        for study in every_study:
            if study.need_of_scheme:
                study.need_of_scheme(plan, scene, scheme, preserves_area)
    for study in every_study:
        if study.need:
            study.need(plan, scene)
    for section in sorted(
        (x for study in every_study for x in study.sections), key=lambda x: x.place
    ):
        if not section.is_requested(scene):
            plan.leave_out(f"{scene_name(scene)}: {section.what}", section.why_not)
