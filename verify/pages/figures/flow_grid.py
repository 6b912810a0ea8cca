"""What stands where in a picture of regions carried by maps: panels of images, in groups."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from verify.pages.text.typography import number, whole
from verify.scenes.results.regions import (
    EXACT_FLOW,
    CarriedOutline,
    DrawnOutline,
    FlowImage,
    FlowResult,
)
from verify.studies.regions.polyline import parsed

_MOST_IN_A_ROW = 6
_MOST_COUNTS = 6
_WITH_OTHERS = 2  # maps at most whose images stand in one panel
_KEPT_SHAPE = 3.0  # an outline that grew longer than this has lost its shape

Curves = tuple[np.ndarray, ...]
"""An image's outlines, arrays (n, 2) of q, p, the region's first."""


@dataclass(frozen=True)
class Panel:
    """A map's images with the number of steps of each.

    `missing`: that of those without an image; `exact`: the exact flow's image, under the others;
    `look`: its colour's place.
    """

    name: str
    images: tuple[tuple[int, Curves], ...]
    missing: tuple[int, ...] = ()
    exact: Curves = ()
    look: int = 0


@dataclass(frozen=True)
class Grid:
    """A group of panels for each number of steps, named so; or one group without a name."""

    counts: tuple[str, ...]
    groups: tuple[tuple[Panel, ...], ...]
    before: Curves
    axes: tuple[str, str] = ("q", "p")

    @property
    def panels(self) -> tuple[Panel, ...]:
        return tuple(panel for group in self.groups for panel in group)

    @property
    def in_a_row(self) -> int:
        """Groups are not broken, as far as one fits."""
        each = len(self.groups[0])
        if not self.counts:
            return each
        whole_groups = max(1, _MOST_IN_A_ROW // each)
        return min(each * whole_groups, len(self.panels))

    @property
    def size(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest (q, p) of what is drawn."""
        images = (curves for panel in self.panels for _, curves in panel.images)
        exact = (panel.exact for panel in self.panels)
        drawn = (self.before, *images, *exact)
        points = np.concatenate([curve for curves in drawn for curve in curves])
        return points.min(axis=0), points.max(axis=0)


def grid_of(flow: FlowResult, plane: int | None = None) -> Grid:
    """All maps' images; at most so many counts, the first and the last of those with an image.

    In n degrees of freedom their projections to the plane (q_k, p_k), k = `plane`, or that in which
    the region lay; in another it was one point.
    """
    maps = tuple(dict.fromkeys(image.map for image in flow.images))
    if flow.plane is not None:
        return _of_plane(flow, maps, plane or flow.plane)
    before = _curves(flow.before)
    if len(maps) <= _WITH_OTHERS and _keep_shape(flow, before):
        together = tuple(
            _panel([image for image in flow.images if image.map == name], look)
            for look, name in enumerate(maps)
        )
        return Grid((), (together,), before)
    return _by_counts(flow, maps, before)


def _of_plane(flow: FlowResult, maps: Sequence[str], k: int) -> Grid:
    before, axes = _curves(flow.before), (f"q{k}", f"p{k}")
    if k != flow.plane:
        before = (np.array([[float(flow.point[name]) for name in axes]]),)
    seen = flow.model_copy(update={"images": tuple(_seen(image, k) for image in flow.images)})
    return replace(_by_counts(seen, maps, before), axes=axes)


def _seen(image: FlowImage, k: int) -> FlowImage:
    """With its outlines as they are seen in the plane (q_k, p_k)."""
    outlines = (
        one.model_copy(update={"points": next(x.points for x in one.projections if x.plane == k)})
        for one in image.outlines
    )
    return image.model_copy(update={"outlines": tuple(outlines)})


def _by_counts(flow: FlowResult, maps: Sequence[str], before: Curves) -> Grid:
    """A group for each number of steps."""
    shown = _some(sorted({image.steps for image in flow.images if image.outlines}))
    found = {(image.map, image.steps): image for image in flow.images}
    times = {image.steps: image.time for image in flow.images}
    schemes = [name for name in maps if name != EXACT_FLOW] or list(maps)
    groups = tuple(
        tuple(
            _panel([found[name, n]], maps.index(name), found.get((EXACT_FLOW, n)))
            for name in schemes
            if (name, n) in found
        )
        for n in shown
    )
    return Grid(tuple(f"N = {whole(n)}, t = {number(times[n])}" for n in shown), groups, before)


def _some(counts: Sequence[int]) -> list[int]:
    places = np.linspace(0, len(counts) - 1, min(len(counts), _MOST_COUNTS))
    return [counts[round(place)] for place in places]


def _panel(images: Sequence[FlowImage], look: int, exact: FlowImage | None = None) -> Panel:
    under = exact if exact and exact.map != images[0].map else None
    return Panel(
        images[0].map,
        tuple((image.steps, _curves(image.outlines)) for image in images if image.outlines),
        tuple(image.steps for image in images if not image.outlines),
        _curves(under.outlines) if under else (),
        look,
    )


def _curves(outlines: Sequence[CarriedOutline | DrawnOutline]) -> Curves:
    return tuple(parsed(outline.points) for outline in outlines)


def _keep_shape(flow: FlowResult, before: Curves) -> bool:
    own = length(before[0])
    images = [_curves(image.outlines[:1]) for image in flow.images if image.outlines]
    return all(length(curves[0]) <= _KEPT_SHAPE * own for curves in images)


def length(curve: np.ndarray) -> float:
    """Of a closed polyline."""
    return float(np.hypot(*(np.roll(curve, -1, axis=0) - curve).T).sum())
