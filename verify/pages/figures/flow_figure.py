"""Regions carried by maps: panels on equal axes, q to the right and p upwards, as inline SVG.

A column is a map. Its images stand in one panel where each keeps its shape; where shear draws them
out, or three maps are compared, each number of steps has a row of its own.
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
from verify.pages.figures.label_place import dots, place_of
from verify.pages.figures.notebook_figure import sheet
from verify.pages.figures.svg import INK, SERIES
from verify.pages.text.typography import number, whole
from verify.scenes.results.regions import CarriedOutline, DrawnOutline, FlowImage, FlowResult
from verify.studies.regions.polyline import parsed, thinned

_WIDTH, _NARROW = 600, 370  # of several columns, of one
_LEFT, _LETTER, _ROW_LABEL, _RIGHT, _TOP, _BOTTOM, _GAP = 26, 7.5, 22, 8, 26, 40, 12
_ROW_PLACE = 10
_LOWEST, _HIGHEST = 0.3, 2.2  # a panel's height by its width
_MOST_ROWS = 6
_WITH_OTHERS = 2  # maps at most whose images stand in one panel
_KEPT_SHAPE = 3.0  # an outline that grew longer than this has lost its shape
_DETAIL = 0.12  # of a point: what is finer is not drawn
_LONG, _THINNER = 20, 0.6  # panel widths: a line so long is drawn with thinner strokes
_ROOM = 0.04  # of the extent, around everything
_LABEL = 11  # of an image, in points
_LETTER_OF_LABEL = 0.62  # its width, as a part of the size
_LINE = 0.7  # points, the region's outline
_LONGEST = 26  # letters of a heading

Curves = tuple[np.ndarray, ...]
"""An image's outlines, arrays (n, 2) of q, p, the region's first."""


@dataclass(frozen=True)
class Panel:
    """Images with the number of steps of each; `missing`: that of those without an image."""

    images: tuple[tuple[int, Curves], ...]
    missing: tuple[int, ...] = ()


@dataclass(frozen=True)
class Grid:
    """Panels at [row][column]; all rows are labelled or, where there is one, none is."""

    columns: tuple[str, ...]
    rows: tuple[str, ...]
    panels: tuple[tuple[Panel, ...], ...]
    before: Curves

    @property
    def size(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest (q, p) of what is drawn."""
        images = (curves for row in self.panels for panel in row for _, curves in panel.images)
        points = np.concatenate([curve for curves in (self.before, *images) for curve in curves])
        return points.min(axis=0), points.max(axis=0)


# -- what stands where ----------------------------------------------------------------------------


def grid_of(flow: FlowResult) -> Grid:
    """All maps' images; at most so many rows, the first and the last of those with an image."""
    maps = tuple(dict.fromkeys(image.map for image in flow.images))
    counts = sorted({image.steps for image in flow.images})
    before = _curves(flow.before)
    together = len(maps) <= _WITH_OTHERS and _keep_shape(flow, before)
    shown = sorted({image.steps for image in flow.images if image.outlines})
    groups = [counts] if together else [[n] for n in _some(shown)]
    found = {(image.map, image.steps): image for image in flow.images}
    times = {image.steps: image.time for image in flow.images}
    return Grid(
        columns=maps,
        rows=() if together else tuple(_row(n, times[n]) for (n,) in groups),
        panels=tuple(
            tuple(_panel([found[m, n] for n in group if (m, n) in found]) for m in maps)
            for group in groups
        ),
        before=before,
    )


def _row(steps: int, time: str) -> str:
    return f"N = {whole(steps)}, t = {number(time)}"


def _some(counts: Sequence[int]) -> list[int]:
    places = np.linspace(0, len(counts) - 1, min(len(counts), _MOST_ROWS))
    return [counts[round(place)] for place in places]


def _panel(images: Sequence[FlowImage]) -> Panel:
    return Panel(
        tuple((image.steps, _curves(image.outlines)) for image in images if image.outlines),
        tuple(image.steps for image in images if not image.outlines),
    )


def _curves(outlines: Sequence[CarriedOutline | DrawnOutline]) -> Curves:
    return tuple(parsed(outline.points) for outline in outlines)


def _keep_shape(flow: FlowResult, before: Curves) -> bool:
    own = _length(before[0])
    images = [_curves(image.outlines[:1]) for image in flow.images if image.outlines]
    return all(_length(curves[0]) <= _KEPT_SHAPE * own for curves in images)


def _length(curve: np.ndarray) -> float:
    return float(np.hypot(*(np.roll(curve, -1, axis=0) - curve).T).sum())


# -- drawing --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Layout:
    """Places in points; one scale for all panels."""

    total: float
    left: float
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
    rows = len(grid.panels)
    high = _TOP + rows * layout.height + (rows - 1) * _GAP + _BOTTOM
    figure = sheet(high, layout.total, layout=None)
    for i, row in enumerate(grid.panels):
        for j, panel in enumerate(row):
            x = layout.left + j * (layout.width + _GAP)
            y = _BOTTOM + (rows - 1 - i) * (layout.height + _GAP)
            place = x / layout.total, y / high, layout.width / layout.total, layout.height / high
            axes = figure.add_axes(place)
            _frame(axes, layout, left=j == 0, bottom=i == rows - 1)
            _draw_panel(axes, panel, grid, SERIES[j % len(SERIES)], layout)
            if i == 0:
                axes.set_title(_heading(j, grid) + _missing(panel, grid))
        if grid.rows:
            y = _BOTTOM + (rows - 0.5 - i) * layout.height + (rows - 1 - i) * _GAP
            figure.text(
                _ROW_PLACE / layout.total,
                y / high,
                grid.rows[i],
                rotation=90,
                ha="center",
                va="center",
            )
    return figure


def _heading(index: int, grid: Grid) -> str:
    """With its letter, where each column is one panel; a paper's letters run through all rows."""
    name, count = grid.columns[index], len(grid.columns)
    longest = max(4, _LONGEST * 3 // count)
    short = name if len(name) <= longest else f"{name[: longest - 1]}…"
    return short if grid.rows or count > 26 else f"({chr(ord('a') + index)}) {short}"


def _missing(panel: Panel, grid: Grid) -> str:
    """Which images a panel of several has not."""
    if grid.rows or not panel.missing:
        return ""
    first, *others = panel.missing
    more = f" and {len(others)} more" if others else ""
    return f"; no image at N = {whole(first)}{more}"


def _layout(grid: Grid) -> _Layout:
    """Equal axes: a panel is as high as what it shows, within limits."""
    low, high = grid.size
    longest = max(len(_tick(y)) for y in _ticks().tick_values(low[1], high[1]))
    left = _LEFT + _LETTER * longest + (_ROW_LABEL if grid.rows else 0)
    columns = len(grid.columns)
    total = _WIDTH if columns > 1 else _NARROW
    width = (total - left - _RIGHT - (columns - 1) * _GAP) / columns
    span = np.maximum(high - low, 1e-300)
    middle, span = (low + high) / 2, span + 2 * _ROOM * span.max()
    if not grid.rows:  # room for the images' labels
        span = span + 2 * (_LABEL + 4) * span[0] / width
    ratio = min(_HIGHEST, max(_LOWEST, float(span[1] / span[0])))
    half = max(span[0], span[1] / ratio) / 2
    reach = np.array([half, half * ratio])
    return _Layout(total, left, width, width * ratio, middle - reach, middle + reach)


def _frame(axes: Any, layout: _Layout, *, left: bool, bottom: bool) -> None:
    axes.set_xlim(layout.low[0], layout.high[0])
    axes.set_ylim(layout.low[1], layout.high[1])
    axes.set_aspect("equal")
    grid_lines(axes, "both")
    for axis, name, shown in ((axes.xaxis, "q", bottom), (axes.yaxis, "p", left)):
        axis.set_major_locator(_ticks())
        axis.set_major_formatter(FuncFormatter(_tick))
        axis.set_tick_params(label1On=shown)
        axis.set_label_text(name, visible=shown)


def _ticks() -> MaxNLocator:
    return MaxNLocator(5, steps=[1, 2, 5, 10])


def _tick(x: float, _: object = None) -> str:
    return f"{x:g}".replace("-", "−")


def _draw_panel(axes: Any, panel: Panel, grid: Grid, colour: str, layout: _Layout) -> None:
    _shape(axes, grid.before, INK, layout, before=True)
    for _, curves in panel.images:
        _shape(axes, curves, colour, layout)
    if not grid.rows:
        _name_all(axes, panel, grid, layout)
    if panel.missing and grid.rows:
        axes.text(0.5, 0.5, "no image", transform=axes.transAxes, ha="center", fontsize=_LABEL)


def _shape(
    axes: Any, curves: Curves, colour: str, layout: _Layout, *, before: bool = False
) -> None:
    """The region lightly filled with a thin line, the other outlines as thinner lines."""
    region, *others = (thinned(curve, _DETAIL / layout.scale) for curve in curves)
    strength = 0.35 if before else 1
    thin = _THINNER if _length(region) > _LONG * (layout.width / layout.scale) else 1
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
    return _length(image[0]) / _length(before[0])
