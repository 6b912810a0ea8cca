"""The arrangement of a picture of regions carried by maps: panels of images, in groups."""

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
from verify.studies.regions.polyline import parse_points

_MOST_IN_A_ROW = 6
_MOST_COUNTS = 6
# The images of at most so many maps are drawn in one panel.
_WITH_OTHERS = 2
# An outline that is stretched more than this has lost its shape.
_MAX_STRETCH = 3.0

Curves = tuple[np.ndarray, ...]
"""An image's outlines, arrays (n, 2) of q, p, the region's first."""


@dataclass(frozen=True)
class Panel:
    """The images of a map with the number of steps of each.

    `missing_counts`: the numbers of steps without an image; `exact`: the exact flow's image, below
    the others; `colour_index`: the place of its colour in `SERIES`.
    """

    name: str
    images: tuple[tuple[int, Curves], ...]
    missing_counts: tuple[int, ...] = ()
    exact: Curves = ()
    colour_index: int = 0


@dataclass(frozen=True)
class Grid:
    """Groups of panels, one for each number of steps in `counts`; or one group without a name."""

    counts: tuple[str, ...]
    groups: tuple[tuple[Panel, ...], ...]
    before: Curves
    axes: tuple[str, str] = ("q", "p")

    @property
    def panels(self) -> tuple[Panel, ...]:
        return tuple(panel for group in self.groups for panel in group)

    @property
    def in_a_row(self) -> int:
        """The number of panels in a row; a group is not broken where it fits into one."""
        each = len(self.groups[0])
        if not self.counts:
            return each
        whole_groups = max(1, _MOST_IN_A_ROW // each)
        return min(each * whole_groups, len(self.panels))

    @property
    def size(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest (q, p) of everything that is drawn."""
        images = (curves for panel in self.panels for _, curves in panel.images)
        exact = (panel.exact for panel in self.panels)
        groups_of_curves = (self.before, *images, *exact)
        points = np.concatenate([curve for curves in groups_of_curves for curve in curves])
        return points.min(axis=0), points.max(axis=0)


def grid_of(flow: FlowResult, plane: int | None = None) -> Grid:
    """Return the images of all maps, for a few numbers of steps including the first and the last.

    In n degrees of freedom they are projected on the plane (q_k, p_k), k = `plane`, by default that
    of the region; in any other plane the region was a single point.
    """
    maps = tuple(dict.fromkeys(image.map for image in flow.images))
    if flow.plane is not None:
        return _grid_of_plane(flow, maps, plane or flow.plane)
    before = _curves(flow.before)
    if len(maps) <= _WITH_OTHERS and _keeps_shape(flow, before):
        together = tuple(
            _panel([image for image in flow.images if image.map == name], look)
            for look, name in enumerate(maps)
        )
        return Grid((), (together,), before)
    return _grid_by_counts(flow, maps, before)


def _grid_of_plane(flow: FlowResult, maps: Sequence[str], k: int) -> Grid:
    before, axes = _curves(flow.before), (f"q{k}", f"p{k}")
    # In another plane the region before the map was a single point.
    if k != flow.plane:
        before = (np.array([[float(flow.point[name]) for name in axes]]),)
    projected = flow.model_copy(
        update={"images": tuple(_project_image(image, k) for image in flow.images)}
    )
    return replace(_grid_by_counts(projected, maps, before), axes=axes)


def _project_image(image: FlowImage, k: int) -> FlowImage:
    """Return the image with its outlines projected on the plane (q_k, p_k)."""
    outlines = (
        outline.model_copy(
            update={"points": next(x.points for x in outline.projections if x.plane == k)}
        )
        for outline in image.outlines
    )
    return image.model_copy(update={"outlines": tuple(outlines)})


def _grid_by_counts(flow: FlowResult, maps: Sequence[str], before: Curves) -> Grid:
    """Return a group of panels for each number of steps."""
    counts = _select_counts(sorted({image.steps for image in flow.images if image.outlines}))
    image_by_map = {(image.map, image.steps): image for image in flow.images}
    times = {image.steps: image.time for image in flow.images}
    schemes = [name for name in maps if name != EXACT_FLOW] or list(maps)
    groups = tuple(
        tuple(
            _panel([image_by_map[name, n]], maps.index(name), image_by_map.get((EXACT_FLOW, n)))
            for name in schemes
            if (name, n) in image_by_map
        )
        for n in counts
    )
    return Grid(tuple(f"N = {whole(n)}, t = {number(times[n])}" for n in counts), groups, before)


def _select_counts(counts: Sequence[int]) -> list[int]:
    places = np.linspace(0, len(counts) - 1, min(len(counts), _MOST_COUNTS))
    return [counts[round(place)] for place in places]


def _panel(images: Sequence[FlowImage], look: int, exact: FlowImage | None = None) -> Panel:
    exact_image = exact if exact and exact.map != images[0].map else None
    return Panel(
        images[0].map,
        tuple((image.steps, _curves(image.outlines)) for image in images if image.outlines),
        tuple(image.steps for image in images if not image.outlines),
        _curves(exact_image.outlines) if exact_image else (),
        look,
    )


def _curves(outlines: Sequence[CarriedOutline | DrawnOutline]) -> Curves:
    return tuple(parse_points(outline.points) for outline in outlines)


def _keeps_shape(flow: FlowResult, before: Curves) -> bool:
    length_before = perimeter(before[0])
    images = [_curves(image.outlines[:1]) for image in flow.images if image.outlines]
    return all(perimeter(curves[0]) <= _MAX_STRETCH * length_before for curves in images)


def perimeter(curve: np.ndarray) -> float:
    """Return the length of a closed polyline (n, 2)."""
    return float(np.hypot(*(np.roll(curve, -1, axis=0) - curve).T).sum())
