"""Regions carried by maps: panels on equal axes, q to the right and p upwards, as inline SVG.

The images of a map stand in one panel where each keeps its shape. Where shear draws them out, or
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

from verify.pages.figures.axes import grid_lines
from verify.pages.figures.flow_grid import Curves, Grid, Panel, length
from verify.pages.figures.label_place import dots, place_of
from verify.pages.figures.notebook_figure import NARROW, WIDE, sheet
from verify.pages.figures.svg import INK, SERIES
from verify.pages.text.typography import whole
from verify.studies.regions.polyline import thinned

_SEVERAL = 600  # points, the width of two or three panels
_LEFT, _LETTER, _RIGHT, _TOP, _BOTTOM, _GAP = 26, 7.5, 8, 24, 40, 12
_SECOND_LINE = 16  # of a heading, in points
_LOWEST, _HIGHEST = 0.3, 2.2  # a panel's height by its width
_DETAIL = 0.12  # of a point: what is finer is not drawn
_LONG, _THINNER = 20, 0.6  # panel widths: a line so long is drawn with thinner strokes
_ROOM = 0.04  # of the extent, around everything
_LABEL = 11  # of an image, in points
_LETTER_OF_LABEL = 0.62  # its width, as a part of the size
_LINE = 0.7  # points, the region's outline
_POINT = 9  # points, what was one point before
_EXACT = 2.2  # points, the line of an exact image under another one

# -- drawing --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Layout:
    """Places in points; one scale for all panels."""

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


def draw_flow(grid: Grid) -> Figure:
    layout = _layout(grid)
    columns = grid.in_a_row
    rows = -(-len(grid.panels) // columns)
    high = rows * (layout.top + layout.height) + (rows - 1) * _GAP + _BOTTOM
    figure = sheet(high, layout.total, layout=None)
    before = _as_seen(grid.before, layout)  # the same in all panels
    for k, panel in enumerate(grid.panels):
        i, j = divmod(k, columns)
        x = layout.left + j * (layout.width + _GAP)
        y = _BOTTOM + (rows - 1 - i) * (layout.height + _GAP + layout.top)
        place = x / layout.total, y / high, layout.width / layout.total, layout.height / high
        axes = figure.add_axes(place)
        _frame(axes, layout, grid.axes, left=j == 0, bottom=k + columns >= len(grid.panels))
        _draw_panel(axes, panel, before, layout)
        if not grid.counts:
            _name_all(axes, panel, grid, layout)
        elif panel.missing:
            axes.text(0.5, 0.5, "no image", transform=axes.transAxes, ha="center", fontsize=_LABEL)
        axes.set_title(_heading(k, grid, int(layout.width / _LETTER)))
    return figure


def _heading(index: int, grid: Grid, most: int) -> str:
    """With its letter, where a panel has all images; else under the count that its group has."""
    panel = grid.panels[index]
    longest = max(4, most if grid.counts else most - len("(a) "))
    name = panel.name if len(panel.name) <= longest else f"{panel.name[: longest - 1]}…"
    if grid.counts:
        group, first = divmod(index, len(grid.groups[0]))
        return f"{'' if first else grid.counts[group]}\n{name}"
    letter = f"({chr(ord('a') + index)}) " if grid.in_a_row <= 26 else ""
    return f"{letter}{name}{_missing(panel)}"


def _missing(panel: Panel) -> str:
    """Which images a panel of several has not."""
    if not panel.missing:
        return ""
    first, *others = panel.missing
    more = f" and {len(others)} more" if others else ""
    return f"; no image at N = {whole(first)}{more}"


def _layout(grid: Grid) -> _Layout:
    """Equal axes: a panel is as high as what it shows, within limits."""
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
    grid_lines(axes, "both")
    for axis, name, shown in ((axes.xaxis, names[0], bottom), (axes.yaxis, names[1], left)):
        axis.set_major_locator(_ticks())
        axis.set_major_formatter(FuncFormatter(_tick))
        axis.set_tick_params(label1On=shown)
        axis.set_label_text(name, visible=shown)


def _ticks() -> MaxNLocator:
    return MaxNLocator(5, steps=[1, 2, 5, 10])


def _tick(x: float, _: object = None) -> str:
    return f"{x:g}".replace("-", "−")


def _draw_panel(axes: Any, panel: Panel, before: Curves, layout: _Layout) -> None:
    if len(before[0]) == 1:  # of another plane than the region's
        axes.plot(*before[0].T, linestyle="none", marker="+", color=INK, markersize=_POINT)
    else:
        _shape(axes, before, INK, layout, before=True)
    if panel.exact:
        path = _path(_as_seen(panel.exact[:1], layout))
        faint = to_rgba(INK, 0.3)
        axes.add_artist(
            PathPatch(path, fill=False, edgecolor=faint, linewidth=_EXACT, clip_on=False)
        )
    for _, curves in panel.images:
        _shape(axes, _as_seen(curves, layout), SERIES[panel.look % len(SERIES)], layout)


def _as_seen(curves: Curves, layout: _Layout) -> Curves:
    """Without the points that the picture does not show."""
    return tuple(thinned(curve, _DETAIL / layout.scale) for curve in curves)


def _shape(
    axes: Any, curves: Curves, colour: str, layout: _Layout, *, before: bool = False
) -> None:
    """The region lightly filled with a thin line, the other outlines as thinner lines."""
    region, *others = curves
    strength = 0.35 if before else 1
    thin = _THINNER if length(region) > _LONG * (layout.width / layout.scale) else 1
    axes.add_artist(
        PathPatch(
            _path([region]), facecolor=to_rgba(colour, 0.1 if before else 0.22),
            edgecolor=to_rgba(colour, strength), linewidth=_LINE * thin, clip_on=False,
        )
    )  # fmt: skip
    if others:
        axes.add_artist(
            PathPatch(
                _path(others), fill=False, edgecolor=to_rgba(colour, strength),
                linewidth=0.45 * thin, clip_on=False,
            )
        )  # fmt: skip


def _path(curves: Sequence[np.ndarray]) -> Path:
    return Path.make_compound_path(*(Path(np.vstack([c, c[:1]]), closed=True) for c in curves))


def _name_all(axes: Any, panel: Panel, grid: Grid, layout: _Layout) -> None:
    """The number of steps beside each image, clear of all that is drawn."""
    low, scale = layout.low, layout.scale
    images = [(n, dots(curves, low, scale)) for n, curves in panel.images]
    everything = np.concatenate([dots(grid.before, low, scale), *(own for _, own in images)])
    room = Bbox.from_bounds(0, 0, layout.width, layout.height)
    taken: list[Bbox] = []
    for steps, own in images:
        text = f"N = {whole(steps)}"
        size = len(text) * _LABEL * _LETTER_OF_LABEL, _LABEL + 2.0
        taken.append(place_of(size, own, everything, taken, room))
        box = taken[-1]
        at = layout.low + np.array([(box.x0 + box.x1) / 2, box.y0 + 1]) / layout.scale
        axes.text(*at, text, ha="center", va="bottom", fontsize=_LABEL)


# -- what is seen ---------------------------------------------------------------------------------


def line_width(grid: Grid) -> float:
    """What the width of an outline's line is in units of q and p: nearer things look as one."""
    return _LINE / _layout(grid).scale


def stretched(before: Curves, image: Curves) -> float:
    """How many times as long the region's outline has become."""
    return length(image[0]) / length(before[0])
