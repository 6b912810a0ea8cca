"""Regions carried by maps: panels on equal axes, q to the right and p upwards, as inline SVG.

The images of a map stand in one panel if each keeps its shape. If shear draws them out, or
three maps are compared, each number of steps has a panel for each scheme, upon the exact image.
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
_SEVERAL = 600
_LEFT, _LETTER, _RIGHT, _TOP, _BOTTOM, _GAP = 26, 7.5, 8, 24, 40, 12
# The height in points of the second line of a heading.
_SECOND_LINE = 16
# The limits of a panel's height divided by its width.
_LOWEST, _HIGHEST = 0.3, 2.2
# Details smaller than this part of a point are not drawn.
_DETAIL = 0.12
# An outline longer than so many panel widths is drawn with strokes thinner by this factor.
_LONG, _THINNER = 20, 0.6
# The margin around everything, as a part of the extent.
_ROOM = 0.04
# The size in points of an image's label.
_LABEL = 11
# The mean width of a letter, as a part of the size of its font.
_LETTER_OF_LABEL = 0.62
# The width in points of the region's outline.
_LINE = 0.7
# The size in points of the mark for a region that was a single point before.
_POINT = 9
# The width in points of the exact image's line, which shows on both sides of the other one.
_EXACT = 2.2

# -- drawing --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Layout:
    """The sizes of a panel in points; all panels have one scale."""

    total: float
    left: float
    top: float
    width: float
    height: float
    low: np.ndarray
    high: np.ndarray

    @property
    def scale(self) -> float:
        """Points to a unit of q and of p."""
        return self.width / float(self.high[0] - self.low[0])


def draw_flow(grid: PanelGrid) -> Figure:
    """Draw the panels of the grid on equal axes of one scale."""
    layout = _layout(grid)
    columns = grid.in_a_row
    rows = -(-len(grid.panels) // columns)
    high = rows * (layout.top + layout.height) + (rows - 1) * _GAP + _BOTTOM
    figure = sheet(high, layout.total, layout=None)
    before = _thin_curves(grid.before, layout)  # the same in all panels
    for k, panel in enumerate(grid.panels):
        i, j = divmod(k, columns)
        x = layout.left + j * (layout.width + _GAP)
        y = _BOTTOM + (rows - 1 - i) * (layout.height + _GAP + layout.top)
        rectangle = x / layout.total, y / high, layout.width / layout.total, layout.height / high
        axes = figure.add_axes(rectangle)
        _frame(axes, layout, grid.axes, left=j == 0, bottom=k + columns >= len(grid.panels))
        _draw_panel(axes, panel, before, layout)
        if not grid.counts:
            _label_images(axes, panel, grid, layout)
        elif panel.missing_counts:
            axes.text(0.5, 0.5, "no image", transform=axes.transAxes, ha="center", fontsize=_LABEL)
        axes.set_title(_heading(k, grid, int(layout.width / _LETTER)))
    return figure


def _heading(index: int, grid: PanelGrid, max_length: int) -> str:
    """Return a panel's title: with its letter, or below the number of steps of its group."""
    panel = grid.panels[index]
    longest = max(4, max_length if grid.counts else max_length - len("(a) "))
    name = panel.name if len(panel.name) <= longest else f"{panel.name[: longest - 1]}…"
    if grid.counts:
        group, first = divmod(index, len(grid.groups[0]))
        return f"{'' if first else grid.counts[group]}\n{name}"
    letter = f"({chr(ord('a') + index)}) " if grid.in_a_row <= 26 else ""
    return f"{letter}{name}{_missing(panel)}"


def _missing(panel: FlowPanel) -> str:
    """Return a note on the numbers of steps for which the panel has no image; else ""."""
    if not panel.missing_counts:
        return ""
    first, *further_counts = panel.missing_counts
    others_text = f" and {len(further_counts)} more" if further_counts else ""
    return f"; no image at N = {whole(first)}{others_text}"


def _layout(grid: PanelGrid) -> _Layout:
    """Return the layout on equal axes; a panel is as high as its content, within limits."""
    low, high = grid.size
    longest = max(len(_tick(y)) for y in _ticks().tick_values(low[1], high[1]))
    left = _LEFT + _LETTER * longest
    columns = grid.in_a_row
    total = NARROW if columns == 1 else _SEVERAL if columns <= 3 else WIDE
    width = (total - left - _RIGHT - (columns - 1) * _GAP) / columns
    span = np.maximum(high - low, 1e-300)
    middle, span = (low + high) / 2, span + 2 * _ROOM * span.max()
    if not grid.counts:  # room for the images' labels
        span = span + 2 * (_LABEL + 4) * span[0] / width
    ratio = min(_HIGHEST, max(_LOWEST, float(span[1] / span[0])))
    half = max(span[0], span[1] / ratio) / 2
    reach = np.array([half, half * ratio])
    top = _TOP + (_SECOND_LINE if grid.counts else 0)
    return _Layout(total, left, top, width, width * ratio, middle - reach, middle + reach)


def _frame(axes: Any, layout: _Layout, names: tuple[str, str], *, left: bool, bottom: bool) -> None:
    axes.set_xlim(layout.low[0], layout.high[0])
    axes.set_ylim(layout.low[1], layout.high[1])
    axes.set_aspect("equal")
    draw_grid(axes, "both")
    for axis, name, is_visible in ((axes.xaxis, names[0], bottom), (axes.yaxis, names[1], left)):
        axis.set_major_locator(_ticks())
        axis.set_major_formatter(FuncFormatter(_tick))
        axis.set_tick_params(label1On=is_visible)
        axis.set_label_text(name, visible=is_visible)


def _ticks() -> MaxNLocator:
    return MaxNLocator(5, steps=[1, 2, 5, 10])


def _tick(x: float, _: object = None) -> str:
    return f"{x:g}".replace("-", "−")


def _draw_panel(axes: Any, panel: FlowPanel, before: Curves, layout: _Layout) -> None:
    if len(before[0]) == 1:  # of another plane than the region's
        axes.plot(*before[0].T, linestyle="none", marker="+", color=INK, markersize=_POINT)
    else:
        _draw_region(axes, before, INK, layout, before=True)
    if panel.exact_curves:
        path = _path(_thin_curves(panel.exact_curves[:1], layout))
        faint = to_rgba(INK, 0.3)
        axes.add_artist(
            PathPatch(path, fill=False, edgecolor=faint, linewidth=_EXACT, clip_on=False)
        )
    for _, curves in panel.images:
        _draw_region(
            axes, _thin_curves(curves, layout), SERIES[panel.colour_index % len(SERIES)], layout
        )


def _thin_curves(curves: Curves, layout: _Layout) -> Curves:
    """Return the curves without the points that are too close together to be visible."""
    return tuple(thin(curve, _DETAIL / layout.scale) for curve in curves)


def _draw_region(
    axes: Any, curves: Curves, colour: str, layout: _Layout, *, before: bool = False
) -> None:
    """Draw the region lightly filled with a thin line, the other outlines as thinner lines."""
    region, *outlines = curves
    strength = 0.35 if before else 1
    thin = _THINNER if perimeter(region) > _LONG * (layout.width / layout.scale) else 1
    axes.add_artist(
        PathPatch(
            _path([region]), facecolor=to_rgba(colour, 0.1 if before else 0.22),
            edgecolor=to_rgba(colour, strength), linewidth=_LINE * thin, clip_on=False,
        )
    )  # fmt: skip
    if outlines:
        axes.add_artist(
            PathPatch(
                _path(outlines), fill=False, edgecolor=to_rgba(colour, strength),
                linewidth=0.45 * thin, clip_on=False,
            )
        )  # fmt: skip


def _path(curves: Sequence[np.ndarray]) -> Path:
    return Path.make_compound_path(*(Path(np.vstack([c, c[:1]]), closed=True) for c in curves))


def _label_images(axes: Any, panel: FlowPanel, grid: PanelGrid, layout: _Layout) -> None:
    """Write the number of steps beside each image, clear of all that is drawn."""
    low, scale = layout.low, layout.scale
    images = [(n, sample_curves(curves, low, scale)) for n, curves in panel.images]
    everything = np.concatenate(
        [sample_curves(grid.before, low, scale), *(points for _, points in images)]
    )
    room = Bbox.from_bounds(0, 0, layout.width, layout.height)
    occupied: list[Bbox] = []
    for steps, points in images:
        text = f"N = {whole(steps)}"
        size = len(text) * _LABEL * _LETTER_OF_LABEL, _LABEL + 2.0
        occupied.append(choose_place(size, points, everything, occupied, room))
        box = occupied[-1]
        corner = layout.low + np.array([(box.x0 + box.x1) / 2, box.y0 + 1]) / layout.scale
        axes.text(*corner, text, ha="center", va="bottom", fontsize=_LABEL)


# -- what is seen ---------------------------------------------------------------------------------


def line_width(grid: PanelGrid) -> float:
    """Return the width of an outline's line in units of q and p, below which curves merge."""
    return _LINE / _layout(grid).scale
