"""Regions carried by maps, and their areas."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.execution.study import Results, Study, results_of_tasks, scene_name, toml_section
from verify.kernels.step.computation import step_map_of
from verify.scenes.frozen import PLAIN
from verify.scenes.observables import carries_defect
from verify.scenes.region_sections import Flow
from verify.scenes.results.regions import EXACT_FLOW, DrawnOutline, FlowImage, FlowResult
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.regions.task import FlowTask


def need_flows(plan: Plan, scene: Scene) -> None:
    """Add the scene's tasks of regions carried by maps to the plan."""
    name = scene_name(scene)
    for flow in scene.flow:
        for task in flow_tasks(scene, flow):
            what = f"{name}: {flow.source or 'flow'}, {task.map} after {task.steps} steps"
            plan.need(task, what)
            if flow.mean_lambda and not task.mean_lambda and task.map != EXACT_FLOW:
                plan.leave_out(*_no_mean(scene, name, task.map))


def _no_mean(scene: Scene, name: str, scheme: str) -> tuple[str, str]:
    exact = scene.exact_hamiltonian()
    structure, evidence = exact.structure, {AREA: "proved", SYMPLECTIC: "shown"}[exact.structure]
    why = f"{structure.identity} is {evidence}: {structure.accumulated} is exactly 0"
    if not step_map_of(exact, scheme).preserves_area:
        why = f"{structure.accumulated} is not carried in {exact.degrees} degrees of freedom"
    return f"{name}: mean of {structure.accumulated} over the region for {scheme}", why


def maps_of(scene: Scene, flow: Flow) -> tuple[str, ...]:
    """Return the exact flow, where it is requested, then the schemes."""
    schemes = flow.schemes or scene.schemes
    return (EXACT_FLOW, *schemes) if flow.exact else schemes


def flow_tasks(scene: Scene, flow: Flow) -> Iterator[FlowTask]:
    """Yield a task for each map and number of steps, in that order."""
    exact = scene.exact_hamiltonian()
    common = scene.hamiltonian_fields()
    shape = flow.placed_shape()
    begin, point = scene.begin, _point(scene, flow)
    for name in maps_of(scene, flow):
        by_scheme = name != EXACT_FLOW
        preserves_area = not by_scheme or step_map_of(exact, name).preserves_area
        for steps in flow.counts:
            yield FlowTask(
                **common,
                map=name,
                shape=shape,
                step_size=flow.step_size,
                t0=begin,
                steps=steps,
                digits=flow.digits,
                mean_lambda=flow.mean_lambda and not preserves_area and carries_defect(exact),
                distance=by_scheme and flow.exact and exact.planar,  # of curves in it
                point=point,
                plane=flow.plane,
            )


def _point(scene: Scene, flow: Flow) -> dict[str, Fraction]:
    """Return the region's place, by the names of H's coordinates; empty in the plane."""
    exact = scene.exact_hamiltonian()
    return {} if exact.planar else flow.point(exact)


def flows_of(scene: Scene, results: Results) -> tuple[FlowResult, ...]:
    """Return a result for each section of the scene that was computed."""
    results_of_flows = (_flow(scene, flow, results) for flow in scene.flow)
    return tuple(each for each in results_of_flows if each.images)


def _flow(scene: Scene, flow: Flow, results: Results) -> FlowResult:
    centre, point = flow.placed_shape().centre, _point(scene, flow)
    return FlowResult(
        shape=flow.shape or ("polygon" if flow.polygon else "path"),
        centre=(text(centre.q), text(centre.p)),
        scale=text(flow.scale),
        step_size=text(flow.step_size),
        before=_outlines_to_draw(flow),
        images=tuple(results_of_tasks(FlowImage, flow_tasks(scene, flow), results)),
        source=flow.source,
        t0=None if scene.begin is None else text(scene.begin),
        plane=flow.plane if point else None,
        point={name: text(x) for name, x in point.items()},
    )


def _outlines_to_draw(flow: Flow) -> tuple[DrawnOutline, ...]:
    from verify.studies.regions.polyline import format_points as points_text
    from verify.studies.regions.polyline import trace_outlines

    shape = flow.placed_shape().to_shape()
    return tuple(
        DrawnOutline(name=outline.name, points=points_text(points))
        for outline, points in zip(shape.outlines, trace_outlines(shape), strict=True)
    )


def flow_json(flows: Sequence[tuple[str, FlowResult]]) -> dict[str, Any]:
    """Return the values of the first scheme after the most steps, then all images.

    They are null where there is no such scheme; `images` have no points.
    """
    images = [
        {"scene": name, "shape": flow.shape, "step_size": flow.step_size} | _without_points(image)
        for name, flow in flows
        for image in flow.images
    ]
    first = next((i for i in images if not i["area_preserving"]), images[0])
    same = [i for i in images if i["map"] == first["map"] and i["scene"] == first["scene"]]
    # Of the images of that map the one after the most steps stands for the scene.
    top = max(same, key=lambda image: image["steps"])
    keys = ("map", "steps", "area_change", "probe_error", "mean_lambda", "mean_defect")
    return {**{name: top[name] for name in keys}, "images": images}


def _without_points(image: FlowImage) -> dict[str, Any]:
    data = image.model_dump(mode="json", context=PLAIN)
    for outline in data["outlines"]:
        for curve in (outline, *outline["projections"]):
            del curve["points"]
    return data


_SECTION = toml_section(7, "regions carried by maps, and their areas", "[[flow]]")
STUDY = Study(
    8,
    (_SECTION,),
    need=need_flows,
    results_for_scene=lambda scene, results: {"flows": flows_of(scene, results)},
)
