"""Regions carried by maps: panels on equal axes, q to the right and p upwards, as inline SVG.

If one or two maps are compared and each image keeps its shape, a map has one panel for all its
images. Otherwise each number of steps has a panel for each scheme, drawn over the exact image.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import Bbox

from verify.pages.figures.axes import draw_grid
from verify.pages.figures.flow_grid import Curves, FlowPanel, PanelGrid, perimeter
from verify.pages.figures.label_place import choose_place, sample_curves
from verify.pages.figures.sheet import INK, NARROW, SERIES, WIDE, sheet
from verify.pages.text.typography import whole
from verify.studies.regions.polyline import thin

# The width in points of a figure with two or three panels.
_MEDIUM_WIDTH = 600
# Margins around the panels in points, the width of a digit at the left, and the gap between panels.
_LEFT, _LETTER_WIDTH, _RIGHT, _TOP, _BOTTOM, _GAP = 26, 7.5, 8, 24, 40, 12
# The height in points of the second line of a heading.
_SECOND_LINE_HEIGHT = 16
# The limits of a panel's height divided by its width.
_MIN_RATIO, _MAX_RATIO = 0.3, 2.2
# Details smaller than this are not drawn, in points.
_LEAST_DETAIL = 0.12
# An outline longer than this number of panel widths is drawn with strokes thinner by this factor.
_LONG_OUTLINE, _THIN_FACTOR = 20, 0.6
# The margin around everything, as a part of the extent.
_MARGIN = 0.04
# The size in points of an image's label.
_LABEL_SIZE = 11
# The mean width of a letter, as a part of the size of its font.
_LABEL_LETTER_RATIO = 0.62
# The width in points of the region's outline.
_LINE_WIDTH = 0.7
# The size in points of the mark for a region whose projection was a single point before.
_MARK_SIZE = 9
# The width in points of the exact image's line, which is visible on both sides of a scheme's line.
_EXACT_LINE_WIDTH = 2.2

# -- drawing --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Layout:
    """The sizes in points of a figure and its panels, which all have one scale.

    `total`: the width of the figure; `left`, `top`: the margins of the first panel; `width`,
    `height`: those of a panel; `low`, `high`: the limits of (q, p) in each panel.
    """

    total: float
    left: float
    top: float
    width: float
    height: float
    low: np.ndarray
    high: np.ndarray

    @property
    def scale(self) -> float:
        """The points in a unit of q and of p."""
        return self.width / float(self.high[0] - self.low[0])


def draw_flow(grid: PanelGrid) -> Figure:
    """Draw the panels of the grid on equal axes of one scale."""
    layout = _compute_layout(grid)
    columns = grid.in_a_row
    rows = -(-len(grid.panels) // columns)
    total_height = rows * (layout.top + layout.height) + (rows - 1) * _GAP + _BOTTOM
    figure = sheet(total_height, layout.total, layout=None)
    before = _thin_curves(grid.before, layout)  # the same in all panels
    for k, panel in enumerate(grid.panels):
        i, j = divmod(k, columns)
        x = layout.left + j * (layout.width + _GAP)
        y = _BOTTOM + (rows - 1 - i) * (layout.height + _GAP + layout.top)
        width, height = layout.width / layout.total, layout.height / total_height
        rectangle = x / layout.total, y / total_height, width, height
        axes = figure.add_axes(rectangle)
        _frame(axes, layout, grid.axes, left=j == 0, bottom=k + columns >= len(grid.panels))
        _draw_panel(axes, panel, before, layout)
        if not grid.counts:
            _label_images(axes, panel, grid, layout)
        elif panel.missing_counts:
            axes.text(
                0.5, 0.5, "no image", transform=axes.transAxes, ha="center", fontsize=_LABEL_SIZE
            )
        axes.set_title(_heading(k, grid, int(layout.width / _LETTER_WIDTH)))
    return figure


def _heading(index: int, grid: PanelGrid, max_length: int) -> str:
    """Return a panel's title: with a letter, or below the heading of its group."""
    panel = grid.panels[index]
    name_length = max(4, max_length if grid.counts else max_length - len("(a) "))
    name = panel.name if len(panel.name) <= name_length else f"{panel.name[: name_length - 1]}…"
    if grid.counts:
        group, position = divmod(index, len(grid.groups[0]))
        # The first panel of a group has the group's heading.
        return f"{'' if position else grid.counts[group]}\n{name}"
    letter = f"({chr(ord('a') + index)}) " if grid.in_a_row <= 26 else ""
    return f"{letter}{name}{_format_missing(panel)}"


def _format_missing(panel: FlowPanel) -> str:
    """Return a note on the numbers of steps for which the panel has no image; else ""."""
    if not panel.missing_counts:
        return ""
    first, *further_counts = panel.missing_counts
    others_text = f" and {len(further_counts)} more" if further_counts else ""
    return f"; no image at N = {whole(first)}{others_text}"


def _compute_layout(grid: PanelGrid) -> _Layout:
    """Return the layout on equal axes; a panel is as high as its content, within limits."""
    low, high = grid.size
    longest_tick = max(len(_format_tick(y)) for y in _ticks().tick_values(low[1], high[1]))
    left = _LEFT + _LETTER_WIDTH * longest_tick
    columns = grid.in_a_row
    total = NARROW if columns == 1 else _MEDIUM_WIDTH if columns <= 3 else WIDE
    width = (total - left - _RIGHT - (columns - 1) * _GAP) / columns
    span = np.maximum(high - low, 1e-300)
    middle, span = (low + high) / 2, span + 2 * _MARGIN * span.max()
    if not grid.counts:  # room for the images' labels
        span = span + 2 * (_LABEL_SIZE + 4) * span[0] / width
    ratio = min(_MAX_RATIO, max(_MIN_RATIO, float(span[1] / span[0])))
    half_width = max(span[0], span[1] / ratio) / 2
    reach = np.array([half_width, half_width * ratio])
    top = _TOP + (_SECOND_LINE_HEIGHT if grid.counts else 0)
    return _Layout(total, left, top, width, width * ratio, middle - reach, middle + reach)


def _frame(axes: Any, layout: _Layout, names: tuple[str, str], *, left: bool, bottom: bool) -> None:
    axes.set_xlim(layout.low[0], layout.high[0])
    axes.set_ylim(layout.low[1], layout.high[1])
    axes.set_aspect("equal")
    draw_grid(axes, "both")
    for axis, name, is_visible in ((axes.xaxis, names[0], bottom), (axes.yaxis, names[1], left)):
        axis.set_major_locator(_ticks())
        axis.set_major_formatter(FuncFormatter(_format_tick))
        axis.set_tick_params(label1On=is_visible)
        axis.set_label_text(name, visible=is_visible)


def _ticks() -> MaxNLocator:
    return MaxNLocator(5, steps=[1, 2, 5, 10])


def _format_tick(x: float, _: object = None) -> str:
    return f"{x:g}".replace("-", "−")


def _draw_panel(axes: Any, panel: FlowPanel, before: Curves, layout: _Layout) -> None:
    if len(before[0]) == 1:  # a projection on another plane than that of the region
        axes.plot(*before[0].T, linestyle="none", marker="+", color=INK, markersize=_MARK_SIZE)
    else:
        _draw_region(axes, before, INK, layout, before=True)
    if panel.exact_curves:
        path = _path(_thin_curves(panel.exact_curves[:1], layout))
        faint = to_rgba(INK, 0.3)
        axes.add_artist(
            PathPatch(path, fill=False, edgecolor=faint, linewidth=_EXACT_LINE_WIDTH, clip_on=False)
        )
    for _, curves in panel.images:
        _draw_region(
            axes, _thin_curves(curves, layout), SERIES[panel.colour_index % len(SERIES)], layout
        )


def _thin_curves(curves: Curves, layout: _Layout) -> Curves:
    """Return the curves without the points that are too close together to be visible."""
    return tuple(thin(curve, _LEAST_DETAIL / layout.scale) for curve in curves)


def _draw_region(
    axes: Any, curves: Curves, colour: str, layout: _Layout, *, before: bool = False
) -> None:
    """Draw the region, which is the first curve, lightly filled; the others are thinner lines."""
    region, *outlines = curves
    alpha = 0.35 if before else 1
    thinness = (
        _THIN_FACTOR if perimeter(region) > _LONG_OUTLINE * (layout.width / layout.scale) else 1
    )
    axes.add_artist(
        PathPatch(
            _path([region]), facecolor=to_rgba(colour, 0.1 if before else 0.22),
            edgecolor=to_rgba(colour, alpha), linewidth=_LINE_WIDTH * thinness, clip_on=False,
        )
    )  # fmt: skip
    if outlines:
        axes.add_artist(
            PathPatch(
                _path(outlines), fill=False, edgecolor=to_rgba(colour, alpha),
                linewidth=0.45 * thinness, clip_on=False,
            )
        )  # fmt: skip


def _path(curves: Sequence[np.ndarray]) -> Path:
    return Path.make_compound_path(*(Path(np.vstack([c, c[:1]]), closed=True) for c in curves))


def _label_images(axes: Any, panel: FlowPanel, grid: PanelGrid, layout: _Layout) -> None:
    """Write the number of steps beside each image, clear of all outlines and other labels."""
    low, scale = layout.low, layout.scale
    images = [(n, sample_curves(curves, low, scale)) for n, curves in panel.images]
    everything = np.concatenate(
        [sample_curves(grid.before, low, scale), *(points for _, points in images)]
    )
    room = Bbox.from_bounds(0, 0, layout.width, layout.height)
    occupied: list[Bbox] = []
    for steps, points in images:
        text = f"N = {whole(steps)}"
        size = len(text) * _LABEL_SIZE * _LABEL_LETTER_RATIO, _LABEL_SIZE + 2.0
        box = choose_place(size, points, everything, occupied, room)
        occupied.append(box)
        corner = layout.low + np.array([(box.x0 + box.x1) / 2, box.y0 + 1]) / layout.scale
        axes.text(*corner, text, ha="center", va="bottom", fontsize=_LABEL_SIZE)


# -- the line width --------------------------------------------------------------------------------


def line_width(grid: PanelGrid) -> float:
    """Return the width of an outline's line in units of q and p: closer curves merge."""
    return _LINE_WIDTH / _compute_layout(grid).scale
