"""Quantities of runs against their step sizes, and printed tables beside computed ones, as SVG.

Logarithms are taken in decimals before anything is drawn, so that 1e-500 has its place too; a zero,
or a value of which no digit is known, has no place on a logarithmic axis and is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    MOST_STYLES,
    draw_grid,
    line_style,
    set_decade_ticks,
    set_step_size_axis,
    set_whole_number_ticks,
)
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import NARROW, WIDE, canvas, legend, sheet
from verify.pages.figures.svg import INK
from verify.pages.text.typography import power_of_h, start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

# The height of a panel in points, including the legend.
_PANEL = 230
# The room for a guide's label, as parts of the axes.
_LABEL_WIDTH, _LABEL_HEIGHT = 0.1, 0.08
# Beyond so many lines in one panel, no line can be told from its neighbours.
MOST_LINES = 120
# Decades between a slope guide and the nearest line.
_GUIDE_GAP = 0.35


@dataclass(frozen=True)
class Line:
    """A line of a logarithmic plot: points (step size, lg of the quantity) by step size."""

    label: str
    points: tuple[tuple[str, float], ...]


# -- the data of a plot ---------------------------------------------------------------------------


def lines(runs: Sequence[RunResult], above: str, below: str = "") -> list[Line]:
    """Return a line for each initial value: lg |values[above]|, or lg of its ratio to `below`."""

    def place(run: RunResult) -> float:
        return _lg(run.values.get(above)) - (_lg(run.values.get(below)) if below else 0)

    return lines_of(runs, place)


def lines_of(runs: Sequence[RunResult], place: Callable[[RunResult], float]) -> list[Line]:
    """Return a line for each initial value through the finite heights that `place` gives."""
    groups: dict[str, list[tuple[str, float]]] = {}
    for run in sorted(runs, key=lambda run: Fraction(run.step_size)):
        height = place(run)
        if isfinite(height):
            groups.setdefault(start(run), []).append((run.step_size, height))
    groups_in_order = {start(run): groups.get(start(run), []) for run in runs}
    return [
        Line(label, tuple(points)) for label, points in groups_in_order.items() if len(points) > 1
    ]


def select_lines(lines: Sequence[Line], most: int = MOST_LINES) -> list[Line]:
    """Return at most `most` lines in their order, evenly spread by height, both ends included.

    >>> [x.label for x in select_lines([Line(str(k), (("1", k % 5),)) for k in range(5)], most=3)]
    ['0', '2', '4']
    """
    if len(lines) <= most:
        return list(lines)
    # Lines are chosen by height, so that the extremes are drawn and the others fill the range.
    by_height = sorted(range(len(lines)), key=lambda k: max(y for _, y in lines[k].points))
    places = {by_height[k * (len(lines) - 1) // (most - 1)] for k in range(most)}
    return [line for k, line in enumerate(lines) if k in places]


def _lg(value: Value | None) -> float:
    return lg(value.value) if value else float("nan")


# -- against the step size ------------------------------------------------------------------------


@dataclass(frozen=True)
class Quantity:
    """A panel over h: its lines, and a grey guide for each power of h in `guides`."""

    title: str
    lines: Sequence[Line]
    guides: Sequence[int] = ()


def draw_against_step_size(quantities: Sequence[Quantity], ax: Any = None) -> Figure:
    """Draw a panel for each quantity on logarithmic axes, side by side, with one legend.

    `ax`: the caller's axes for a single quantity, which have the legend inside; without them a new
    figure is made.
    """
    labels = list(dict.fromkeys(line.label for each in quantities for line in each.lines))
    figure = ax.figure if ax else sheet(_PANEL, WIDE if len(quantities) > 1 else NARROW)
    panels = [ax] if ax else figure.subplots(1, len(quantities), squeeze=False)[0]
    for axes, each in zip(panels, quantities, strict=True):
        for line in each.lines:
            plot_line(axes, line, line_style(labels.index(line.label), len(labels)))
        _guides(axes, each.lines, each.guides)
        _frame(axes, each.lines)
        set_decade_ticks(axes.yaxis)
        axes.set_title(each.title)
    if len(labels) <= MOST_STYLES + 1:
        # A line may have too few points for a panel; the panel with most lines has the whole
        # legend.
        fullest = max(panels, key=lambda axes: len(axes.get_legend_handles_labels()[1]))
        legend(None if ax else figure, fullest, ncols=2 if len(quantities) == 1 else 5)
    return figure


def draw_printed_against_computed(computed_lines: Sequence[Line], printed: Line) -> Figure:
    """Draw lg MSE as printed and as computed."""
    figure, axes = canvas(350)
    plot_line(axes, printed, {"color": INK, "linewidth": 3})
    for index, line in enumerate(computed_lines):
        plot_line(axes, line, line_style(index, len(computed_lines)))
    _frame(axes, [printed, *computed_lines])
    legend(figure, axes, ncols=2)
    set_whole_number_ticks(axes.yaxis)
    axes.set_title("lg MSE")
    return figure


def plot_line(axes: Any, line: Line, style: dict[str, Any]) -> None:
    """Plot the line over lg h."""
    x, y = [lg(h) for h, _ in line.points], [place for _, place in line.points]
    axes.plot(x, y, label=line.label, **style)


def _frame(axes: Any, plotted: Sequence[Line]) -> None:
    set_step_size_axis(axes, [h for line in plotted for h, _ in line.points])
    draw_grid(axes)
    axes.margins(y=0.08)


def _guides(axes: Any, plotted: Sequence[Line], slopes: Sequence[int]) -> None:
    """Draw straight lines of these slopes above all points, labelled where they lie apart."""
    if not slopes:
        return
    points = [(lg(h), y) for line in plotted for h, y in line.points]
    ends = min(x for x, _ in points), max(x for x, _ in points)
    heights = {s: max(y - s * x for x, y in points) + _GUIDE_GAP for s in slopes}
    spreads = [
        max(ends_heights) - min(ends_heights)
        for ends_heights in ([c + s * x for s, c in heights.items()] for x in ends)
    ]
    left = spreads[0] >= spreads[1]
    x = ends[0] if left else ends[1]
    # A rising line must not cross its own label, nor the next line a label below it.
    rise = _LABEL_WIDTH * (ends[1] - ends[0])
    height_of_all = max(y for _, y in points) - min(y for _, y in points) + 1
    room = _LABEL_HEIGHT * height_of_all + max(slopes) * rise
    lowest = float("-inf")
    for slope, height in sorted(heights.items(), key=lambda item: item[0] * x + item[1]):
        base = max(slope * x + height, lowest)
        axes.plot(
            ends, [base + slope * (e - x) for e in ends], color=INK, alpha=0.55, linewidth=0.9
        )
        axes.annotate(
            f"∝ {power_of_h(slope)}",
            (x, base + slope * rise * left), xytext=(0, 2), textcoords="offset points",
            ha="left" if left else "right", fontsize=11,
        )  # fmt: skip
        lowest = base + room
