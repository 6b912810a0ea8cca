"""What the pictures of regions carried by maps let one see, in sentences; each from the data."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from verify.pages.figures.flow_figure import line_width, stretched
from verify.pages.figures.flow_grid import Grid
from verify.pages.text.typography import IS, listed, map_name, whole
from verify.scenes.results.regions import FlowResult

_NEAR = 2  # widths of a line: what lies so near hides what it lies on, nearly
_NOTED = 1.5  # times as long: an outline drawn out so far is spoken of


def picture_sentences(flow: FlowResult, grid: Grid) -> Iterator[str]:
    if len(grid.before[0]) == 1:
        yield "+ is where all of it was before."
        return
    yield from _stretched(grid)
    yield from _upon_each_other(flow, line_width(grid))
    yield from _upon_before(grid)


def _stretched(grid: Grid) -> Iterator[str]:
    """By the first map that has images, at the most steps: for the eye the others are as it is."""
    first = grid.panels[0]
    own = [panel for panel in grid.panels if panel.name == first.name]
    images = [image for panel in own for image in panel.images]
    if not images:
        return
    steps, curves = max(images, key=lambda image: image[0])
    times = stretched(grid.before, curves)
    if times >= _NOTED:
        said = whole(round(times)) if times >= 10 else f"{times:.1f}"
        yield (
            f"After N{IS}{whole(steps)} steps by {map_name(first.name)} the outline is "
            f"{said} times as long as before."
        )


def _upon_each_other(flow: FlowResult, line: float) -> Iterator[str]:
    """Which maps' images lie nearer to the exact ones than the width of a line."""
    furthest: dict[str, Fraction] = {}
    for image in flow.images:
        if image.distance is not None:
            most = abs(Fraction(image.distance)) + Fraction(image.distance_error or 0)
            furthest[image.map] = max(most, furthest.get(image.map, Fraction(0)))
    same = [name for name, most in furthest.items() if most < line]
    apart = [name for name in furthest if name not in same]
    if same:
        yield f"All images by {listed(same)} lie within a line’s width of the exact ones."
    if apart:
        yield f"Some images by {listed(apart)} lie further from the exact ones than a line’s width."


def _upon_before(grid: Grid) -> Iterator[str]:
    """Images that hide what was before."""
    hidden = {
        steps
        for panel in grid.panels
        for steps, curves in panel.images
        if _lies_upon(curves[0], grid.before[0], _NEAR * line_width(grid))
    }
    if hidden:
        counts = listed([f"N{IS}{whole(n)}" for n in sorted(hidden)])
        yield f"At {counts} the image lies within two lines’ widths of the grey one and hides it."


def _lies_upon(curve: np.ndarray, other: np.ndarray, width: float) -> bool:
    """Whether two closed polylines (n, 2) keep within that width of each other, by their corners.

    Their boxes tell it of most; the distance itself, which is exact, is slow to compile for a page.
    """
    ends = np.array([curve.min(0) - other.min(0), curve.max(0) - other.max(0)])
    if np.abs(ends).max() >= width:
        return False
    return max(_farthest(curve, other), _farthest(other, curve)) < width


def _farthest(points: np.ndarray, curve: np.ndarray) -> float:
    """The greatest distance of the points from the curve's segments."""
    along = np.roll(curve, -1, axis=0) - curve
    apart = points[:, None] - curve[None]
    share = (apart * along).sum(-1) / np.maximum((along * along).sum(-1), np.finfo(float).tiny)
    nearest = apart - np.clip(share, 0, 1)[..., None] * along
    return float(np.hypot(nearest[..., 0], nearest[..., 1]).min(1).max())
