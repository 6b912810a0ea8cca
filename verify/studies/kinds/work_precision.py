"""Error against run time."""

from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Study, called, toml_section
from verify.scenes.scene import Scene
from verify.studies.work_precision.plan import work_precision_task


def _need(plan: Plan, scene: Scene) -> None:
    if scene.work_precision:
        task = work_precision_task(scene, scene.work_precision)
        plan.need(task, f"{called(scene)}: error against run time")
        for peer, why in task.peers_left_out:
            plan.leave_out(f"{called(scene)}: {peer} beside the schemes", why)


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.work_precision is None:
        return {}
    return {"work_precision": results[work_precision_task(scene, scene.work_precision).key]}


_SECTION = toml_section(6, "error against run time", "[work_precision]")
STUDY = Study(7, (_SECTION,), need=_need, found=_found)
