"""Truncation and rounding in Λ against the step size, with the crossovers marked, as inline SVG."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import Mark, draw_grid, line_style, mark_places, set_decade_ticks
from verify.pages.figures.figures import Line, plot_line
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import canvas_on, legend
from verify.pages.figures.separation_caption import lines_of_ways, round_crossover
from verify.pages.text.typography import NBSP
from verify.scenes.results.separation import WAYS, SeparationGrid

_HEIGHT = 255
# The width of a mark's label, as a part of the axes.
_ROOM = 0.45


def line(label: str, points: Sequence[tuple[str, str]]) -> Line:
    """Return the line through the points (step size, quantity) with finite logarithms."""
    placed = sorted(((h, lg(size)) for h, size in points), key=lambda point: lg(point[0]))
    return Line(label, tuple((h, place) for h, place in placed if isfinite(place)))


def lines_and_marks(grid: SeparationGrid) -> tuple[list[Line], list[Mark]]:
    """Return the lines of two points or more, and the crossovers that exist."""
    lines = [line(label, points) for label, points in lines_of_ways(grid)]
    marks = [
        (lg(crossover.step_size), f"h* ≈{NBSP}{round_crossover(crossover.step_size)}, {way_name}")
        for way, way_name in WAYS.items()
        if (crossover := getattr(grid, way)).step_size is not None
    ]
    return [each for each in lines if len(each.points) > 1], marks


def draw_truncation_against_rounding(
    plotted: Sequence[Line], marks: Sequence[Mark], ax: Any = None
) -> Figure:
    """Draw the lines on logarithmic axes, with a dashed vertical line and a label for each mark.

    `ax`: the caller's axes, which have the legend inside; without them a new figure is made.
    """
    figure, axes = canvas_on(ax, _HEIGHT)
    for index, each in enumerate(plotted):
        plot_line(axes, each, line_style(index, len(plotted)))
    axes.margins(x=0.05, y=0.06)
    mark_places(axes, sorted(marks), _ROOM)
    draw_grid(axes)
    set_decade_ticks(axes.xaxis, max_ticks=7)
    set_decade_ticks(axes.yaxis)
    axes.set_xlabel("step size h (logarithmic)")
    axes.set_title("greatest |part of Λ|")
    legend(figure if ax is None else None, axes)
    return figure
