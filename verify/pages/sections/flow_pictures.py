"""Sentences on what is visible in pictures of regions carried by maps, from the data."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from verify.pages.figures.flow_figure import line_width, stretch_of_outline
from verify.pages.figures.flow_grid import Grid
from verify.pages.text.typography import IS, join_and, map_name, whole
from verify.scenes.results.regions import FlowResult

# An outline within so many widths of a line from another nearly hides it.
_NEAR_WIDTHS = 2
# A stretch is mentioned if the outline is at least so many times as long as before.
_MIN_STRETCH = 1.5


def picture_sentences(flow: FlowResult, grid: Grid) -> Iterator[str]:
    """Yield the sentences on a picture of this region."""
    if len(grid.before[0]) == 1:
        yield "+ is where all of it was before."
        return
    yield from _describe_stretch(grid)
    yield from _compare_with_exact(flow, line_width(grid))
    yield from _describe_hidden_outline(grid)


def _describe_stretch(grid: Grid) -> Iterator[str]:
    """Yield how far the first map with images stretches; to the eye the others do the same."""
    first = grid.panels[0]
    panels = [panel for panel in grid.panels if panel.name == first.name]
    images = [image for panel in panels for image in panel.images]
    if not images:
        return
    steps, curves = max(images, key=lambda image: image[0])
    stretch = stretch_of_outline(grid.before, curves)
    if stretch >= _MIN_STRETCH:
        factor = whole(round(stretch)) if stretch >= 10 else f"{stretch:.1f}"
        yield (
            f"After N{IS}{whole(steps)} steps by {map_name(first.name)} the outline is "
            f"{factor} times as long as before."
        )


def _compare_with_exact(flow: FlowResult, line: float) -> Iterator[str]:
    """Yield the maps whose images lie within a line's width of the exact ones, and the others."""
    furthest: dict[str, Fraction] = {}
    for image in flow.images:
        if image.distance is not None:
            most = abs(Fraction(image.distance)) + Fraction(image.distance_error or 0)
            furthest[image.map] = max(most, furthest.get(image.map, Fraction(0)))
    same = [name for name, most in furthest.items() if most < line]
    further = [name for name in furthest if name not in same]
    if same:
        yield f"All images by {join_and(same)} lie within a line’s width of the exact ones."
    if further:
        yield (
            f"Some images by {join_and(further)} lie further from the exact ones than a line’s "
            "width."
        )


def _describe_hidden_outline(grid: Grid) -> Iterator[str]:
    """Yield the numbers of steps whose image hides the outline before."""
    hiding_counts = {
        steps
        for panel in grid.panels
        for steps, curves in panel.images
        if _lies_upon(curves[0], grid.before[0], _NEAR_WIDTHS * line_width(grid))
    }
    if hiding_counts:
        counts = join_and([f"N{IS}{whole(n)}" for n in sorted(hiding_counts)])
        yield f"At {counts} the image lies within two lines’ widths of the grey one and hides it."


def _lies_upon(curve: np.ndarray, other: np.ndarray, width: float) -> bool:
    """Return True if two closed polylines (n, 2) lie within that width of each other.

    The corners alone are compared. Most pairs are decided by their boxes; the exact distance is
    not used, since it takes long to compile for a page.
    """
    # Boxes that differ by the width decide at once; else all corners are compared.
    ends = np.array([curve.min(0) - other.min(0), curve.max(0) - other.max(0)])
    if np.abs(ends).max() >= width:
        return False
    return max(_farthest(curve, other), _farthest(other, curve)) < width


def _farthest(points: np.ndarray, curve: np.ndarray) -> float:
    """Return the greatest distance of the points (n, 2) from the curve's segments."""
    segments = np.roll(curve, -1, axis=0) - curve
    offsets = points[:, None] - curve[None]
    # The denominator of a segment of no length must not be 0.
    share = (offsets * segments).sum(-1) / np.maximum(
        (segments * segments).sum(-1), np.finfo(float).tiny
    )
    nearest = offsets - np.clip(share, 0, 1)[..., None] * segments
    return float(np.hypot(nearest[..., 0], nearest[..., 1]).min(1).max())
