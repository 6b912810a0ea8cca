"""A picture of regions carried by maps: groups of panels, and sentences on what is visible."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from verify.pages.text.typography import IS, join_and, map_name, number, whole
from verify.scenes.results.regions import (
    EXACT_FLOW,
    CarriedOutline,
    DrawnOutline,
    FlowImage,
    FlowResult,
)
from verify.studies.regions.polyline import parse_points

_MAX_IN_A_ROW = 6
_MAX_COUNTS = 6
# The limit on maps if a map has one panel for all its images.
_MAX_MAPS_TOGETHER = 2
# An outline that is stretched more than this has lost its shape.
_MAX_STRETCH = 3.0
# An outline within this number of line widths of another nearly hides it.
_NEAR_WIDTHS = 2
# A stretch is mentioned if the outline is longer than before by at least this factor.
_MIN_STRETCH = 1.5

Curves = tuple[np.ndarray, ...]
"""An image's outlines, arrays (n, 2) of q, p, the region's first."""


@dataclass(frozen=True)
class FlowPanel:
    """The images of a map with the number of steps of each.

    `missing_counts`: the numbers of steps without an image; `exact_curves`: the exact flow's image,
    drawn below the others; `colour_index`: an index into `SERIES`.
    """

    name: str
    images: tuple[tuple[int, Curves], ...]
    missing_counts: tuple[int, ...] = ()
    exact_curves: Curves = ()
    colour_index: int = 0


@dataclass(frozen=True)
class PanelGrid:
    """Groups of panels, one for each heading in `counts`; if `counts` is empty, one group."""

    counts: tuple[str, ...]
    groups: tuple[tuple[FlowPanel, ...], ...]
    before: Curves
    axes: tuple[str, str] = ("q", "p")

    @property
    def panels(self) -> tuple[FlowPanel, ...]:
        return tuple(panel for group in self.groups for panel in group)

    @property
    def in_a_row(self) -> int:
        """The number of panels in a row; a group is not broken if it fits into one."""
        group_size = len(self.groups[0])
        if not self.counts:
            return group_size
        whole_groups = max(1, _MAX_IN_A_ROW // group_size)
        return min(group_size * whole_groups, len(self.panels))

    @property
    def size(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest (q, p) of everything that is drawn."""
        images = (curves for panel in self.panels for _, curves in panel.images)
        exact_images = (panel.exact_curves for panel in self.panels)
        groups_of_curves = (self.before, *images, *exact_images)
        points = np.concatenate([curve for curves in groups_of_curves for curve in curves])
        return points.min(axis=0), points.max(axis=0)


def grid_of(flow: FlowResult, plane: int | None = None) -> PanelGrid:
    """Return the images of all maps, for a few numbers of steps including the first and the last.

    In n degrees of freedom they are projected on the plane (q_k, p_k), k = `plane`, by default that
    of the region; in any other plane the region was a single point.
    """
    maps = tuple(dict.fromkeys(image.map for image in flow.images))
    if flow.plane is not None:
        return _grid_of_plane(flow, maps, plane or flow.plane)
    before = _curves(flow.before)
    if len(maps) <= _MAX_MAPS_TOGETHER and _keeps_shape(flow, before):
        together = tuple(
            _panel([image for image in flow.images if image.map == name], colour_index)
            for colour_index, name in enumerate(maps)
        )
        return PanelGrid((), (together,), before)
    return _grid_by_counts(flow, maps, before)


def _grid_of_plane(flow: FlowResult, maps: Sequence[str], k: int) -> PanelGrid:
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


def _grid_by_counts(flow: FlowResult, maps: Sequence[str], before: Curves) -> PanelGrid:
    """Return a group of panels for each of a few numbers of steps, a panel for each scheme."""
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
    return PanelGrid(
        tuple(f"N = {whole(n)}, t = {number(times[n])}" for n in counts), groups, before
    )


def _select_counts(counts: Sequence[int]) -> list[int]:
    indices = np.linspace(0, len(counts) - 1, min(len(counts), _MAX_COUNTS))
    return [counts[round(index)] for index in indices]


def _panel(
    images: Sequence[FlowImage], colour_index: int, exact_flow_image: FlowImage | None = None
) -> FlowPanel:
    exact_image = (
        exact_flow_image if exact_flow_image and exact_flow_image.map != images[0].map else None
    )
    return FlowPanel(
        images[0].map,
        tuple((image.steps, _curves(image.outlines)) for image in images if image.outlines),
        tuple(image.steps for image in images if not image.outlines),
        _curves(exact_image.outlines) if exact_image else (),
        colour_index,
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


# -- what is visible ------------------------------------------------------------------------------


def picture_sentences(flow: FlowResult, grid: PanelGrid, line_width: float) -> Iterator[str]:
    """Yield the sentences on what is visible in a picture of this region, from the data.

    `line_width`: that of an outline in units of q and p, below which curves merge.
    """
    if len(grid.before[0]) == 1:
        yield "+ is where all of it was before."
        return
    yield from _describe_stretch(grid)
    yield from _compare_with_exact(flow, line_width)
    yield from _describe_hidden_outline(grid, line_width)


def _describe_stretch(grid: PanelGrid) -> Iterator[str]:
    """Yield how far the first map stretches the outline; the others look much the same."""
    map_of_first_panel = grid.panels[0].name
    panels = [panel for panel in grid.panels if panel.name == map_of_first_panel]
    images = [image for panel in panels for image in panel.images]
    if not images:
        return
    steps, curves = max(images, key=lambda image: image[0])
    stretch = perimeter(curves[0]) / perimeter(grid.before[0])
    if stretch >= _MIN_STRETCH:
        factor = whole(round(stretch)) if stretch >= 10 else f"{stretch:.1f}"
        yield (
            f"After N{IS}{whole(steps)} steps by {map_name(map_of_first_panel)} the outline is "
            f"{factor} times as long as before."
        )


def _compare_with_exact(flow: FlowResult, line_width: float) -> Iterator[str]:
    """Yield the maps whose images lie within a line's width of the exact ones, and the others."""
    greatest_distances: dict[str, Fraction] = {}
    for image in flow.images:
        if image.distance is not None:
            bound = abs(Fraction(image.distance)) + Fraction(image.distance_error or 0)
            earlier = greatest_distances.get(image.map, Fraction(0))
            greatest_distances[image.map] = max(bound, earlier)
    near_maps = [name for name, bound in greatest_distances.items() if bound < line_width]
    far_maps = [name for name in greatest_distances if name not in near_maps]
    if near_maps:
        yield f"All images by {join_and(near_maps)} lie within a line’s width of the exact ones."
    if far_maps:
        yield (
            f"Some images by {join_and(far_maps)} lie further from the exact ones than a line’s "
            "width."
        )


def _describe_hidden_outline(grid: PanelGrid, line_width: float) -> Iterator[str]:
    """Yield the numbers of steps whose image hides the outline of the region before."""
    hiding_counts = {
        steps
        for panel in grid.panels
        for steps, curves in panel.images
        if _lies_upon(curves[0], grid.before[0], _NEAR_WIDTHS * line_width)
    }
    if hiding_counts:
        counts = join_and([f"N{IS}{whole(n)}" for n in sorted(hiding_counts)])
        yield f"At {counts} the image lies within two lines’ widths of the grey one and hides it."


def _lies_upon(curve: np.ndarray, other_curve: np.ndarray, width: float) -> bool:
    """Return True if two closed polylines (n, 2) lie within that width of each other.

    The corners of each are compared with the segments of the other. The exact Hausdorff distance is
    not used, as its code takes long to compile.
    """
    # Bounding boxes that differ by the width decide at once.
    box_differences = np.array(
        [curve.min(0) - other_curve.min(0), curve.max(0) - other_curve.max(0)]
    )
    if np.abs(box_differences).max() >= width:
        return False
    return max(_farthest(curve, other_curve), _farthest(other_curve, curve)) < width


def _farthest(points: np.ndarray, curve: np.ndarray) -> float:
    """Return the greatest distance of the points (n, 2) from the segments of the closed curve."""
    segments = np.roll(curve, -1, axis=0) - curve
    offsets = points[:, None] - curve[None]
    # The nearest point of a segment, as a part of its length; the length may be 0.
    positions = (offsets * segments).sum(-1) / np.maximum(
        (segments * segments).sum(-1), np.finfo(float).tiny
    )
    differences = offsets - np.clip(positions, 0, 1)[..., None] * segments
    return float(np.hypot(differences[..., 0], differences[..., 1]).min(1).max())
