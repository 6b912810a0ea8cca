"""What was found of a scene's regions carried by maps, in the order the scene asks for them."""

from collections.abc import Sequence
from typing import Any

from verify.arithmetic.exact import text
from verify.execution.study import Results, known_results
from verify.scenes.frozen import PLAIN
from verify.scenes.region_sections import Flow
from verify.scenes.results.regions import DrawnOutline, FlowImage, FlowResult
from verify.scenes.scene import Scene
from verify.studies.regions.plan import flow_tasks


def flows_of(scene: Scene, results: Results) -> tuple[FlowResult, ...]:
    """One a section of the scene that was computed."""
    found = (_flow(scene, flow, results) for flow in scene.flow)
    return tuple(each for each in found if each.images)


def _flow(scene: Scene, flow: Flow, results: Results) -> FlowResult:
    exact, centre = scene.exact_hamiltonian(), flow.placed_shape().centre
    return FlowResult(
        shape=flow.shape or ("polygon" if flow.polygon else "path"),
        centre=(text(centre.q), text(centre.p)),
        scale=text(flow.scale),
        step_size=text(flow.step_size),
        before=_outlines_to_draw(flow),
        images=tuple(known_results(FlowImage, flow_tasks(scene, flow), results)),
        source=flow.source,
        t0=text(scene.t0) if exact.time_dependent else None,
        plane=None if exact.planar else flow.plane,
        point={} if exact.planar else {n: text(x) for n, x in flow.point(exact).items()},
    )


def _outlines_to_draw(flow: Flow) -> tuple[DrawnOutline, ...]:
    from verify.studies.regions.polyline import text as points_text
    from verify.studies.regions.polyline import traced

    shape = flow.placed_shape().to_shape()
    return tuple(
        DrawnOutline(name=outline.name, points=points_text(points))
        for outline, points in zip(shape.outlines, traced(shape), strict=True)
    )


def flow_json(found: Sequence[tuple[str, FlowResult]]) -> dict[str, Any]:
    """The scene's first scheme after the most steps, then all images.

    Those keys are null where there is no such scheme; `images` have no points.
    """
    images = [
        {"scene": name, "shape": flow.shape, "step_size": flow.step_size} | _without_points(image)
        for name, flow in found
        for image in flow.images
    ]
    first = next((i for i in images if not i["area_preserving"]), images[0])
    same = [i for i in images if i["map"] == first["map"] and i["scene"] == first["scene"]]
    top = max(same, key=lambda image: image["steps"])
    keys = ("map", "steps", "area_change", "probe_error", "mean_lambda", "mean_defect")
    return {**{name: top[name] for name in keys}, "images": images}


def _without_points(image: FlowImage) -> dict[str, Any]:
    data = image.model_dump(mode="json", context=PLAIN)
    for outline in data["outlines"]:
        for drawn in (outline, *outline["projections"]):
            del drawn["points"]
    return data
