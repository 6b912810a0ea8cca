"""Results on regions that are carried by maps: areas, their changes, and curves to draw."""

from pydantic import Field

from verify.prose import Prose
from verify.scenes.frozen import Frozen, ProseText, Seconds, WithProse

EXACT_FLOW = "exact flow"


class Projection(Frozen):
    """A closed outline after a map in n degrees of freedom, as it is seen in the plane (q_k, p_k).

    `plane`: k, from 1. `area`: what the projection encloses, ∮ p_k dq_k with its sign, by the area
    before the map; the sum of all planes' is 1 + `area_change`. `area_error` a bound on its error.
    `points` its curve as `q,p q,p …`, thinned for drawing.
    """

    plane: int
    area: str
    area_error: str
    points: str


class CarriedOutline(Frozen):
    """One closed outline after a map. All numbers are decimal strings.

    `area` is that of the region it bounded before the map, `area_change` the relative change of it,
    `probe_error` a bound on the error of `area_change`; `points` its curve as `q,p q,p …`, thinned
    for drawing; `nodes` how many points the area was measured with. In n degrees of freedom the
    area is that of ω, ∮ p·dq along the outline, `points` are those in the plane that the region lay
    in, and `projections` has each plane.
    """

    name: str
    area: str
    area_change: str
    probe_error: str
    nodes: int
    points: str
    projections: tuple[Projection, ...] = ()


class DrawnOutline(Frozen):
    """A closed outline as it is drawn: `points` is `q,p q,p …`."""

    name: str
    points: str


class FlowImage(WithProse):
    """A shape after `steps` steps of one map, the first outline being that of its region.

    `map` is a scheme's name or `EXACT_FLOW`. `area_change` and `probe_error` are the region's;
    `mean_lambda` is the mean of Λ over the region, with its error; `distance` the Hausdorff
    distance of its outlines from those of the exact flow, the greatest of all of them. `agree`:
    the change of area and the mean of Λ are equal within their errors. A value that was not
    requested, or is not known, is None. `area_preserving`: det J ≡ 1 by proof (for the exact flow
    by Liouville's theorem). `problem` says why there is no image, or why its area tells nothing.

    In n degrees of freedom the area is that of ω, ∮ p·dq; in place of Λ stands W's entry at
    (p_i, q_i), the defect of all steps in the region's plane, with its mean `mean_defect`; there is
    no distance; and `area_preserving` says that S ≡ 0 is proved (for the exact flow by Poincaré's
    theorem).
    """

    map: str
    steps: int
    time: str
    area_preserving: bool | None
    problem: ProseText = Prose()
    area_change: str | None = None
    probe_error: str | None = None
    mean_lambda: str | None = None
    mean_lambda_error: str | None = None
    mean_defect: str | None = None
    mean_defect_error: str | None = None
    agree: bool | None = None
    distance: str | None = None
    distance_error: str | None = None
    arithmetic: str = ""
    digits: int = 0
    method: str = ""
    seconds: Seconds
    outlines: tuple[CarriedOutline, ...] = ()


class FlowResult(Frozen):
    """A shape carried by maps: its outlines before, and its images by map, then by steps.

    `centre` (q, p) and `scale`: the place and size of the shape; `t0`: the start time, where H
    depends on time. `source`: the part of a paper that it repeats (`Figure 4`). In n degrees of
    freedom `plane` is the i of the plane (q_i, p_i) of the shape and of `centre`, and `point` has
    all coordinates of the centre by their names; in the plane they are None and empty.
    """

    shape: str
    centre: tuple[str, str]
    scale: str
    step_size: str
    before: tuple[DrawnOutline, ...]
    images: tuple[FlowImage, ...]
    source: str = ""
    t0: str | None = None
    plane: int | None = None
    point: dict[str, str] = Field(default_factory=dict)
