"""Λ as the growth law predicts it and as it was measured, against the step size, as inline SVG."""

from collections.abc import Sequence
from typing import Any, Literal

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    MOST_STYLES,
    draw_grid,
    line_style,
    set_decade_ticks,
    set_step_size_axis,
)
from verify.pages.figures.figures import Line, plot_line
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import WIDE, sheet
from verify.pages.figures.svg import INK
from verify.pages.text.typography import start
from verify.scenes.results.growth import GrowthLawResult

_HEIGHT = 260
# Decades between the guide and the points below it.
_GUIDE_GAP = 0.4
# The number of columns of the legend.
_LEGEND = 5


def draw_predicted_against_measured(orbits: Sequence[GrowthLawResult]) -> Figure:
    """Draw (a) |Λ|, measured points on predicted lines, and (b) |relative difference| over h."""
    figure = sheet(_HEIGHT, WIDE)
    left, right = figure.subplots(1, 2)
    for index, orbit in enumerate(orbits):
        style = line_style(index, len(orbits))
        _prediction(left, orbit, style)
        plot_line(right, _line(orbit, "difference"), style)
    _guide(right, [_line(orbit, "difference") for orbit in orbits])
    sizes = [p.step_size for orbit in orbits for p in orbit.predictions]
    for axes in (left, right):
        draw_grid(axes)
        axes.margins(y=0.08)
        set_decade_ticks(axes.yaxis, max_ticks=6)
        set_step_size_axis(axes, sizes)
    left.set_title("(a) |Λ|: points measured, lines predicted")
    right.set_title("(b) |predicted − measured| / |measured|")
    if len(orbits) <= MOST_STYLES:
        handles, labels = left.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=_LEGEND, handlelength=3.2)
    return figure


def _line(orbit: GrowthLawResult, quantity: Literal["predicted", "measured", "difference"]) -> Line:
    """Return the line of a quantity of which a digit is known at each step size."""
    points = ((p.step_size, lg(getattr(p, quantity).value)) for p in orbit.predictions)
    return Line(start(orbit.law), tuple(points))


def _prediction(axes: Any, orbit: GrowthLawResult, style: dict[str, Any]) -> None:
    """Plot the predicted line without marks, and the measured marks without a line."""
    plot_line(axes, _line(orbit, "predicted"), {**style, "marker": None})
    points = {"color": style["color"], "marker": style.get("marker", "o"), "markersize": 5}
    plot_line(axes, _line(orbit, "measured"), {**points, "linestyle": "none"})
    # One entry an orbit: the mark on its line.
    line, marks = axes.lines[-2:]
    line.set_label("_")
    marks.set_label("_")
    axes.plot([], [], label=start(orbit.law), **style)


def _guide(axes: Any, lines: Sequence[Line]) -> None:
    """Draw a line of slope 1 above all points, labelled at its left end."""
    points = [(lg(h), y) for line in lines for h, y in line.points]
    if not points:
        return
    ends = min(x for x, _ in points), max(x for x, _ in points)
    height = max(y - x for x, y in points) + _GUIDE_GAP
    axes.plot(ends, [height + x for x in ends], color=INK, alpha=0.55, linewidth=0.9)
    axes.annotate(
        "∝ h", (ends[0], height + ends[0]), xytext=(0, 4), textcoords="offset points",
        ha="left", fontsize=11,
    )  # fmt: skip
