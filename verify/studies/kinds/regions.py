"""Regions carried by maps, and their areas."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any, Literal

from pydantic import Field

from verify.arithmetic.exact import text
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, Study, results_of_tasks, scene_name, toml_section
from verify.execution.task import HamiltonianTask
from verify.kernels.step.computation import step_map_of
from verify.scenes.frozen import PLAIN
from verify.scenes.observables import carries_defect
from verify.scenes.region_sections import PlacedShape, RegionFlow
from verify.scenes.results.regions import EXACT_FLOW, DrawnOutline, FlowImage, FlowResult
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber, StepSize
from verify.structures import AREA, SYMPLECTIC

_COST, _POINTS = 40_000_000, 40_000  # of a region, and how many points of it are carried


class FlowTask(HamiltonianTask):
    """Carry a shape by `steps` steps of a map: a scheme's, or the exact flow's."""

    result = FlowImage
    imports = ("verify.studies.regions.region_image", "verify.studies.regions.point_carriers")
    kind: Literal["flow"] = "flow"
    map: str
    shape: PlacedShape
    step_size: StepSize
    t0: ExactNumber | None = None
    steps: int
    digits: int
    mean_lambda: bool
    distance: bool
    point: dict[str, ExactNumber] = Field(default_factory=dict)
    """The centre's coordinates by their names; `plane`: in which it lies. Left out: p and q."""
    plane: int = 1

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST + _POINTS * self.steps

    @property
    def ensemble(self) -> str | None:
        """A key of the maps of one region: they carry mostly the same points of it.

        They are compared with the same exact ones, too.
        """
        return f"{self.kind} {self.hamiltonian} {self.parameters} {self.shape} {self.t0 or 0}"

    @property
    def turn(self) -> float:
        """The time: maps over longer ones come later, and carry on the points of the others."""
        return float(self.step_size * self.steps)

    def compute(self, keeper: Keeper) -> FlowImage:
        """Return the images of the outline as a result."""
        from verify.studies.regions.point_carriers import QP_PLANE, RegionPlane
        from verify.studies.regions.region_image import carry

        plane = RegionPlane.from_point(self.point, self.plane) if self.point else QP_PLANE
        shape = self.shape.to_shape()
        arguments = self.other_fields("map", "shape", "point", "plane")
        return carry(self.exact_hamiltonian(), self.map, shape, plane=plane, **arguments)


def need_flows(plan: Plan, scene: Scene) -> None:
    """Add the scene's tasks of regions carried by maps to the plan."""
    name = scene_name(scene)
    for flow in scene.flow:
        for task in flow_tasks(scene, flow):
            reason = f"{name}: {flow.source or 'flow'}, {task.map} after {task.steps} steps"
            plan.need(task, reason)
            if flow.mean_lambda and not task.mean_lambda and task.map != EXACT_FLOW:
                plan.leave_out(*_no_mean(scene, name, task.map))


def _no_mean(scene: Scene, name: str, scheme: str) -> tuple[str, str]:
    hamiltonian = scene.exact_hamiltonian()
    structure = hamiltonian.structure
    evidence = {AREA: "proved", SYMPLECTIC: "shown"}[hamiltonian.structure]
    reason = f"{structure.identity} is {evidence}: {structure.accumulated} is exactly 0"
    if not step_map_of(hamiltonian, scheme).preserves_area:
        reason = (
            f"{structure.accumulated} is not carried in {hamiltonian.degrees} degrees of freedom"
        )
    return f"{name}: mean of {structure.accumulated} over the region for {scheme}", reason


def maps_of(scene: Scene, flow: RegionFlow) -> tuple[str, ...]:
    """Return the exact flow, where it is requested, then the schemes."""
    schemes = flow.schemes or scene.schemes
    return (EXACT_FLOW, *schemes) if flow.exact else schemes


def flow_tasks(scene: Scene, flow: RegionFlow) -> Iterator[FlowTask]:
    """Yield a task for each map and number of steps, in that order."""
    hamiltonian = scene.exact_hamiltonian()
    common = scene.hamiltonian_fields()
    shape = flow.placed_shape()
    begin, point = scene.begin, _point(scene, flow)
    for name in maps_of(scene, flow):
        is_scheme = name != EXACT_FLOW
        preserves_area = not is_scheme or step_map_of(hamiltonian, name).preserves_area
        for steps in flow.counts:
            yield FlowTask.from_object(
                flow,
                **common,
                map=name,
                shape=shape,
                t0=begin,
                steps=steps,
                mean_lambda=flow.mean_lambda and not preserves_area and carries_defect(hamiltonian),
                # Hausdorff distances are of curves in the plane.
                distance=is_scheme and flow.exact and hamiltonian.planar,
                point=point,
            )


def _point(scene: Scene, flow: RegionFlow) -> dict[str, Fraction]:
    """Return the region's place, by the names of H's coordinates; empty in the plane."""
    hamiltonian = scene.exact_hamiltonian()
    return {} if hamiltonian.planar else flow.point(hamiltonian)


def flows_of(scene: Scene, results: Results) -> tuple[FlowResult, ...]:
    """Return a result for each section of the scene that was computed."""
    flow_results = (_flow(scene, flow, results) for flow in scene.flow)
    return tuple(result for result in flow_results if result.images)


def _flow(scene: Scene, flow: RegionFlow, results: Results) -> FlowResult:
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


def _outlines_to_draw(flow: RegionFlow) -> tuple[DrawnOutline, ...]:
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
