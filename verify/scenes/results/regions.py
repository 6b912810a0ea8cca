"""What was found of regions that are carried by maps: areas, their changes, and curves to draw."""

from verify.prose import Prose
from verify.scenes.frozen import Frozen, Said, Seconds, WithProse

EXACT_FLOW = "exact flow"


class CarriedOutline(Frozen):
    """One closed outline after a map. All numbers are decimal strings.

    `area` is that of the region it bounded before the map, `area_change` the relative change of it,
    `probe_error` a bound on the error of `area_change`; `points` its curve as `q,p q,p …`, thinned
    for drawing; `nodes` how many points the area was measured with.
    """

    name: str
    area: str
    area_change: str
    probe_error: str
    nodes: int
    points: str


class DrawnOutline(Frozen):
    """A closed outline as it is drawn: `points` is `q,p q,p …`."""

    name: str
    points: str


class FlowImage(WithProse):
    """A shape after `steps` steps of one map, the first outline being that of its region.

    `map` is a scheme's name or `EXACT_FLOW`. `area_change` and `probe_error` are the region's;
    `mean_lambda` is the mean of Λ over the region, with its error; `distance` the Hausdorff
    distance of its outlines from those of the exact flow, the greatest of all of them. `agree`:
    the change of area and the mean of Λ are the same within their errors. What was not asked for,
    or is not known, is None. `area_preserving`: det J ≡ 1 by proof (for the exact flow by
    Liouville's theorem). `problem` says why there is no image, or why its area tells nothing.
    """

    map: str
    steps: int
    time: str
    area_preserving: bool | None
    problem: Said = Prose()
    area_change: str | None = None
    probe_error: str | None = None
    mean_lambda: str | None = None
    mean_lambda_error: str | None = None
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

    `centre` (q, p) and `scale`: where the shape was put, and how large; `t0`: when, where H depends
    on time. `source`: what of a paper it repeats (`Figure 4`).
    """

    shape: str
    centre: tuple[str, str]
    scale: str
    step_size: str
    before: tuple[DrawnOutline, ...]
    images: tuple[FlowImage, ...]
    source: str = ""
    t0: str | None = None
