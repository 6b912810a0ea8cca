"""A scene's regions carried by maps → the tasks that they need."""

from collections.abc import Iterator

from verify.execution.plan import Plan
from verify.execution.study import called
from verify.kernels.step.computation import step_map_of
from verify.scenes.observables import carries_defect
from verify.scenes.region_sections import Flow
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.scene import Scene
from verify.studies.regions.task import FlowTask


def need_flows(plan: Plan, scene: Scene) -> None:
    """Adds what the scene asks for of regions carried by maps."""
    name = called(scene)
    for flow in scene.flow:
        for task in flow_tasks(scene, flow):
            what = f"{name}: {flow.source or 'flow'}, {task.map} after {task.steps} steps"
            plan.need(task, what)
            if flow.mean_lambda and not task.mean_lambda and task.map != EXACT_FLOW:
                plan.leave_out(*_no_mean(scene, name, task.map))


def _no_mean(scene: Scene, name: str, scheme: str) -> tuple[str, str]:
    exact = scene.exact_hamiltonian()
    if exact.planar:
        why = "ΔJ ≡ 0 is proved: Λ is exactly 0"
        return f"{name}: mean of Λ over the region for {scheme}", why
    why = "S ≡ 0 is shown: W is exactly 0"
    if not step_map_of(exact, scheme).preserves_area:
        why = f"W is not carried in {exact.degrees} degrees of freedom"
    return f"{name}: mean of W over the region for {scheme}", why


def maps_of(scene: Scene, flow: Flow) -> tuple[str, ...]:
    """The exact flow, where it is asked for, then the schemes."""
    schemes = flow.schemes or scene.schemes
    return (EXACT_FLOW, *schemes) if flow.exact else schemes


def flow_tasks(scene: Scene, flow: Flow) -> Iterator[FlowTask]:
    """One a map and number of steps, in that order."""
    exact, given, shape = scene.exact_hamiltonian(), scene.hamiltonian_fields(), flow.placed_shape()
    for name in maps_of(scene, flow):
        by_scheme = name != EXACT_FLOW
        kept = not by_scheme or step_map_of(exact, name).preserves_area
        for steps in flow.counts:
            yield FlowTask(
                **given,
                map=name,
                shape=shape,
                step_size=flow.step_size,
                t0=scene.t0 if exact.time_dependent else None,
                steps=steps,
                digits=flow.digits,
                mean_lambda=flow.mean_lambda and not kept and carries_defect(exact),
                distance=by_scheme and flow.exact and exact.planar,
                point={} if exact.planar else flow.point(exact),
                plane=flow.plane,
            )
