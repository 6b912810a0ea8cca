"""Orbits once in each period, in the (q, p) plane, a panel a scheme, as SVG."""

from collections.abc import Iterator, Sequence
from math import remainder, tau

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from verify.pages.figures.axes import grid_lines
from verify.pages.figures.notebook_figure import NARROW, WIDE, sheet
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.stroboscopic import SchemeSections, StroboscopicOrbit

_HEIGHT = 330
MOST_DRAWN = 6000  # points of a figure
_MARK, _FAINT = 2.2, 0.35
_ROOM = 0.05
Points = Sequence[tuple[float, float]]


def drawn_periods(sections: Sequence[SchemeSections]) -> int:
    """How many of the first periods are drawn, of all orbits alike."""
    orbits = sum(len(each.orbits) for each in sections)
    longest = max((len(o.points) for each in sections for o in each.orbits), default=1) - 1
    return min(longest, max(1, MOST_DRAWN // max(1, orbits)))


def draw_sections(sections: Sequence[SchemeSections], q_is_angle: bool) -> Figure:
    """Each orbit in a colour; what more digits do not confirm is grey. An angle is in (−π, π]."""
    count, periods = len(sections), drawn_periods(sections)
    figure = sheet(_HEIGHT, WIDE if count > 1 else NARROW)
    (row,) = figure.subplots(1, count, sharex=True, sharey=True, squeeze=False)
    for axes, each in zip(row, sections, strict=True):
        for index, orbit in enumerate(each.orbits):
            points = _points(orbit, q_is_angle)[: periods + 1]
            known = orbit.known + 1
            style = {"linestyle": "none", "marker": ".", "markersize": _MARK}
            axes.plot(*_columns(points[known:]), color=INK, alpha=_FAINT, **style)
            axes.plot(*_columns(points[:known]), color=SERIES[index % len(SERIES)], **style)
        axes.set_title(each.scheme)
        axes.set_xlabel("q")
        axes.margins(_ROOM)
        grid_lines(axes, "both")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
            axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}".replace("-", "−")))
    row[0].set_ylabel("p", rotation=0, labelpad=10)
    return figure


def _points(orbit: StroboscopicOrbit, q_is_angle: bool) -> Points:
    points = [(float(q), float(p)) for q, p in orbit.points]
    return [(remainder(q, tau), p) for q, p in points] if q_is_angle else points


def _columns(points: Points) -> Iterator[list[float]]:
    yield [q for q, _ in points]
    yield [p for _, p in points]
