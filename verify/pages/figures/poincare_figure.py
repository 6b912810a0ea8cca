"""Orbits where they pass a surface, a panel a map, as SVG."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from verify.pages.figures.axes import grid_lines
from verify.pages.figures.notebook_figure import NARROW, WIDE, sheet
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.poincare import MapSections, PoincareResult

_HEIGHT, _IN_A_ROW = 330, 3
_MOST_DRAWN = 6000  # points of a figure
_MARK, _FAINT = 3.0, 0.35
_ROOM = 0.05
_FEW = 0.02  # of the points on either side, which may lie far out: of orbits that escape
_WIDER = 0.5  # of the extent of the others, on either side


def drawn_passes(sections: Sequence[MapSections]) -> int:
    """How many of the first passes are drawn, of all orbits alike."""
    orbits = sum(len(each.orbits) for each in sections)
    longest = max((len(o.points) for each in sections for o in each.orbits), default=0)
    return min(longest, max(1, _MOST_DRAWN // max(1, orbits)))


def drawn(result: PoincareResult) -> tuple[list[list[np.ndarray]], int]:
    """Of each map each orbit's first points (n, 2), and how many of all lie too far out to be
    drawn, as those of orbits that escape do: they have nan in their place.
    """
    shown = drawn_passes(result.sections)
    points = [
        [np.array(o.points[:shown], dtype=np.float64).reshape(-1, 2) for o in each.orbits]
        for each in result.sections
    ]
    every = np.concatenate([x for each in points for x in each])
    if not len(every):
        return points, 0
    low, high = np.quantile(every, (_FEW, 1 - _FEW), axis=0)
    room = _WIDER * (high - low)
    outside = 0
    for orbit in (x for each in points for x in each):
        far = ((orbit < low - room) | (orbit > high + room)).any(axis=1)
        outside += int(far.sum())
        orbit[far] = np.nan
    return points, outside


def draw_passes(result: PoincareResult) -> Figure:
    """Each orbit in a colour, grey where it is not known; the same axes for all maps."""
    sections, (points, _) = result.sections, drawn(result)
    count = len(sections)
    columns = min(count, _IN_A_ROW)
    rows = -(-count // columns)
    figure = sheet(_HEIGHT * rows, WIDE if count > 1 else NARROW)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, each, own in zip(panels.flat, sections, points, strict=False):
        _draw(axes, each, own)
        axes.set_title(each.map)
        axes.set_xlabel(result.draw[0])
        axes.margins(_ROOM)
        grid_lines(axes, "both")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
            axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}".replace("-", "−")))
        axes.tick_params(labelbottom=True)
    for axes in panels.flat[count:]:
        axes.set_axis_off()
    for row in panels:
        row[0].set_ylabel(result.draw[1], rotation=0, labelpad=10)
    return figure


def _draw(axes: Any, sections: MapSections, points: Sequence[np.ndarray]) -> None:
    for index, (orbit, own) in enumerate(zip(sections.orbits, points, strict=True)):
        style = {"linestyle": "none", "marker": ".", "markersize": _MARK}
        for part, look in (
            (own[orbit.known :], {"color": INK, "alpha": _FAINT}),
            (own[: orbit.known], {"color": SERIES[index % len(SERIES)]}),
        ):
            axes.plot(*part.T, **look, **style)
