"""Orbits where they pass a surface, a panel a map, as SVG."""

from collections.abc import Sequence
from typing import Any

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


def drawn_passes(sections: Sequence[MapSections]) -> int:
    """How many of the first passes are drawn, of all orbits alike."""
    orbits = sum(len(each.orbits) for each in sections)
    longest = max((len(o.points) for each in sections for o in each.orbits), default=0)
    return min(longest, max(1, _MOST_DRAWN // max(1, orbits)))


def draw_passes(result: PoincareResult) -> Figure:
    """Each orbit in a colour, grey where it is not known; the same axes for all maps."""
    sections = result.sections
    count, shown = len(sections), drawn_passes(sections)
    columns = min(count, _IN_A_ROW)
    rows = -(-count // columns)
    figure = sheet(_HEIGHT * rows, WIDE if count > 1 else NARROW)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, each in zip(panels.flat, sections, strict=False):
        _draw(axes, each, shown)
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


def _draw(axes: Any, sections: MapSections, shown: int) -> None:
    for index, orbit in enumerate(sections.orbits):
        points = [(float(x), float(y)) for x, y in orbit.points[:shown]]
        style = {"linestyle": "none", "marker": ".", "markersize": _MARK}
        for part, look in (
            (points[orbit.known :], {"color": INK, "alpha": _FAINT}),
            (points[: orbit.known], {"color": SERIES[index % len(SERIES)]}),
        ):
            axes.plot([x for x, _ in part], [y for _, y in part], **look, **style)
