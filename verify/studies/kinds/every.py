"""Proofs about the scene's schemes for every H."""

from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, results_of_tasks, scene_name
from verify.scenes.results.proof import EveryResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.studies.proofs.every import EveryTask


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    if not scene.every_hamiltonian:
        return
    if get(scheme).every_h is None:
        plan.leave_out(f"{scene_name(scene)}: {scheme} for every H", "it is given for one H")
    else:
        plan.need(_task(scene, scheme), f"{scene_name(scene)}: what holds for every H")


def _task(scene: Scene, scheme: str) -> EveryTask:
    exact = scene.exact_hamiltonian()
    return EveryTask(scheme=scheme, timed=exact.time_dependent, degrees=exact.degrees)


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    tasks = [_task(scene, name) for name in scene.schemes if scene.every_hamiltonian]
    return {"every": tuple(results_of_tasks(EveryResult, tasks, results))}


_SECTION = Section(
    0,
    "proofs for every H",
    "the scene does not say `every_hamiltonian = true`",
    lambda scene: scene.every_hamiltonian,
)
STUDY = Study(1, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
