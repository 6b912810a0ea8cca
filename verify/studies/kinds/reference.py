"""Reference data, which a command of its own makes."""

from verify.execution.plan import Plan, Study, scene_name
from verify.scenes.scene import Scene


def _need(plan: Plan, scene: Scene) -> None:
    if scene.reference:
        plan.leave_out(f"{scene_name(scene)}: reference data", "`verify reference make` makes it")


STUDY = Study(10, need=_need)
