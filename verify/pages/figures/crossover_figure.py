"""Truncation and rounding in Λ against the step size, with the crossovers marked, as inline SVG."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import Mark, decades, grid_lines, line_style, mark_places
from verify.pages.figures.figures import Line, plot_line
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import canvas_on, legend
from verify.pages.figures.separation_caption import short, ways_of
from verify.pages.text.typography import NBSP
from verify.scenes.results.separation import WAYS, SeparationGrid

_HEIGHT = 255
_ROOM = 0.45  # of the axes: what a mark's label takes


def line(label: str, points: Sequence[tuple[str, str]]) -> Line:
    """The points (step size, quantity) whose logarithm is finite, by step size."""
    placed = sorted(((h, lg(size)) for h, size in points), key=lambda point: lg(point[0]))
    return Line(label, tuple((h, place) for h, place in placed if isfinite(place)))


def contents(grid: SeparationGrid) -> tuple[list[Line], list[Mark]]:
    """The lines of two points and more, and the crossovers that were found."""
    lines = [line(label, points) for label, points in ways_of(grid)]
    marks = [
        (lg(found.step_size), f"h* ≈{NBSP}{short(found.step_size)}, {of}")
        for way, of in WAYS.items()
        if (found := getattr(grid, way)).step_size is not None
    ]
    return [each for each in lines if len(each.points) > 1], marks


def draw_truncation_against_rounding(
    plotted: Sequence[Line], marks: Sequence[Mark], ax: Any = None
) -> Figure:
    """The lines on logarithmic axes; a dashed vertical line, labelled above them, for each mark.

    `ax`: axes of the caller's, with the legend inside; a figure of its own without them.
    """
    figure, axes = canvas_on(ax, _HEIGHT)
    for index, each in enumerate(plotted):
        plot_line(axes, each, line_style(index, len(plotted)))
    axes.margins(x=0.05, y=0.06)
    mark_places(axes, sorted(marks), _ROOM)
    grid_lines(axes)
    decades(axes.xaxis, most=7)
    decades(axes.yaxis)
    axes.set_xlabel("step size h (logarithmic)")
    axes.set_title("greatest |part of Λ|")
    legend(figure if ax is None else None, axes)
    return figure
