"""Figures over the step size: runs, printed tables, parts of Λ, the growth law.

Logarithms are taken of decimals before anything is drawn, so that 1e-500 has a place too; a zero,
or a value without a known digit, has none on a logarithmic axis and is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite, nan
from typing import Any, Literal

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    MOST_STYLES,
    LabelledAbscissa,
    draw_grid,
    line_style,
    mark_places,
    set_decade_ticks,
    set_step_size_axis,
    set_whole_number_ticks,
)
from verify.pages.figures.captioned_plot import lg, round_crossover
from verify.pages.figures.sheet import INK, NARROW, WIDE, canvas, canvas_on, draw_legend, sheet
from verify.pages.text.typography import NBSP, power_of_h, start
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import WAYS, SeparationGrid

# The heights in points of the figures, including the legend: of runs, of a printed table, of the
# parts of Λ, and of the growth law.
_RUNS_HEIGHT, _TABLE_HEIGHT, _PARTS_HEIGHT, _GROWTH_HEIGHT = 230, 350, 255, 260
# The width and height of a guide's label, as parts of the axes.
_LABEL_WIDTH, _LABEL_HEIGHT = 0.1, 0.08
# The limit on lines in one panel: with more, a line cannot be told from its neighbours.
MOST_LINES = 120
# Decades between a slope guide and the nearest line, of runs and of the growth law.
_GUIDE_GAP, _GROWTH_GUIDE_GAP = 0.35, 0.4
# The width of a crossover's label, as a part of the axes.
_CROSSOVER_WIDTH = 0.45
# The lines of a separation: evaluation, part, label.
_SEPARATED_LINES = (
    ("plain", "truncation", "truncation"),
    ("plain", "total", "rounding, the plain way"),
    ("closed_form", "total", "rounding, closed form and log1p summation"),
)


@dataclass(frozen=True)
class LogarithmicLine:
    """A line of a logarithmic plot: points (step size, lg of the quantity) by step size."""

    label: str
    points: tuple[tuple[str, float], ...]


# -- the data of a plot ---------------------------------------------------------------------------


def lines(runs: Sequence[RunResult], quantity: str, divisor: str = "") -> list[LogarithmicLine]:
    """Return a line for each initial value: lg |quantity|, or lg of its ratio to `divisor`."""

    def lg_of(run: RunResult, name: str) -> float:
        return lg(run.values[name].value) if run.values.get(name) else nan

    def height(run: RunResult) -> float:
        return lg_of(run, quantity) - (lg_of(run, divisor) if divisor else 0)

    return lines_of(runs, height)


def lines_of(
    runs: Sequence[RunResult], height_of: Callable[[RunResult], float]
) -> list[LogarithmicLine]:
    """Return a line for each initial value with two finite heights or more, by `height_of`."""
    groups: dict[str, list[tuple[str, float]]] = {}
    for run in sorted(runs, key=lambda run: Fraction(run.step_size)):
        height = height_of(run)
        if isfinite(height):
            groups.setdefault(start(run), []).append((run.step_size, height))
    groups_in_order = {start(run): groups.get(start(run), []) for run in runs}
    return [
        LogarithmicLine(label, tuple(points))
        for label, points in groups_in_order.items()
        if len(points) > 1
    ]


def select_lines(lines: Sequence[LogarithmicLine], most: int = MOST_LINES) -> list[LogarithmicLine]:
    """Return at most `most` lines in their order, evenly spread by height, both ends included.

    >>> steps = [LogarithmicLine(str(k), (("1", k % 5),)) for k in range(5)]
    >>> [line.label for line in select_lines(steps, most=3)]
    ['0', '2', '4']
    """
    if len(lines) <= most:
        return list(lines)
    # Lines are chosen by height, so that the extremes are drawn and the others fill the range.
    by_height = sorted(range(len(lines)), key=lambda k: max(y for _, y in lines[k].points))
    indices = {by_height[k * (len(lines) - 1) // (most - 1)] for k in range(most)}
    return [line for k, line in enumerate(lines) if k in indices]


# -- against the step size ------------------------------------------------------------------------


@dataclass(frozen=True)
class QuantityPanel:
    """A panel over h: its lines, and a grey guide for each power of h in `guides`."""

    title: str
    lines: Sequence[LogarithmicLine]
    guides: Sequence[int] = ()


def draw_against_step_size(quantities: Sequence[QuantityPanel], ax: Any = None) -> Figure:
    """Draw a panel for each quantity on logarithmic axes, side by side, with one legend.

    `ax`: the caller's axes for a single quantity, which have the legend inside; without them a new
    figure is made.
    """
    labels = list(dict.fromkeys(line.label for panel in quantities for line in panel.lines))
    figure = ax.figure if ax else sheet(_RUNS_HEIGHT, WIDE if len(quantities) > 1 else NARROW)
    panels = [ax] if ax else figure.subplots(1, len(quantities), squeeze=False)[0]
    for axes, panel in zip(panels, quantities, strict=True):
        for line in panel.lines:
            plot_line(axes, line, line_style(labels.index(line.label), len(labels)))
        _guides(axes, panel.lines, panel.guides)
        _frame(axes, panel.lines)
        set_decade_ticks(axes.yaxis)
        axes.set_title(panel.title)
    if len(labels) <= MOST_STYLES + 1:
        # A line may have too few points for a panel; the panel with most lines has the whole
        # legend.
        fullest = max(panels, key=lambda axes: len(axes.get_legend_handles_labels()[1]))
        draw_legend(None if ax else figure, fullest, ncols=2 if len(quantities) == 1 else 5)
    return figure


def draw_printed_against_computed(
    computed_lines: Sequence[LogarithmicLine], printed: LogarithmicLine
) -> Figure:
    """Draw lg MSE as printed and as computed."""
    figure, axes = canvas(_TABLE_HEIGHT)
    plot_line(axes, printed, {"color": INK, "linewidth": 3})
    for index, line in enumerate(computed_lines):
        plot_line(axes, line, line_style(index, len(computed_lines)))
    _frame(axes, [printed, *computed_lines])
    draw_legend(figure, axes, ncols=2)
    set_whole_number_ticks(axes.yaxis)
    axes.set_title("lg MSE")
    return figure


def plot_line(axes: Any, line: LogarithmicLine, style: dict[str, Any]) -> None:
    """Plot the line over lg h."""
    x, y = [lg(h) for h, _ in line.points], [height for _, height in line.points]
    axes.plot(x, y, label=line.label, **style)


def _frame(axes: Any, plotted: Sequence[LogarithmicLine]) -> None:
    set_step_size_axis(axes, [h for line in plotted for h, _ in line.points])
    draw_grid(axes)
    axes.margins(y=0.08)


def _guides(axes: Any, plotted: Sequence[LogarithmicLine], slopes: Sequence[int]) -> None:
    """Draw straight lines of these slopes above all points, labelled at the end where they part."""
    if not slopes:
        return
    points = [(lg(h), y) for line in plotted for h, y in line.points]
    ends = min(x for x, _ in points), max(x for x, _ in points)
    heights = {s: max(y - s * x for x, y in points) + _GUIDE_GAP for s in slopes}
    spreads = [
        max(end_heights) - min(end_heights)
        for end_heights in ([c + s * x for s, c in heights.items()] for x in ends)
    ]
    is_left = spreads[0] >= spreads[1]
    x = ends[0] if is_left else ends[1]
    # A rising line must not cross its own label, nor the next line the label below it.
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
            (x, base + slope * rise * is_left), xytext=(0, 2), textcoords="offset points",
            ha="left" if is_left else "right", fontsize=11,
        )  # fmt: skip
        lowest = base + room


# -- truncation and rounding in Λ -----------------------------------------------------------------


def lines_and_marks(grid: SeparationGrid) -> tuple[list[LogarithmicLine], list[LabelledAbscissa]]:
    """Return the lines with two points or more, and the crossovers that exist."""
    lines = [_separated_line(grid, *line_keys) for line_keys in _SEPARATED_LINES]
    marks = [
        (lg(crossover.step_size), f"h* ≈{NBSP}{round_crossover(crossover.step_size)}, {label}")
        for way, label in WAYS.items()
        if (crossover := getattr(grid, way)).step_size is not None
    ]
    return [line for line in lines if len(line.points) > 1], marks


def _separated_line(grid: SeparationGrid, way: str, part: str, label: str) -> LogarithmicLine:
    """Return the line of a part's greatest size along each run, if its logarithm is finite."""
    evaluations = ((point.step_size, getattr(point, way)) for point in grid.points)
    sizes = ((h, lg(evaluation.largest[part])) for h, evaluation in evaluations if evaluation)
    finite = (point for point in sizes if isfinite(point[1]))
    return LogarithmicLine(label, tuple(sorted(finite, key=lambda point: lg(point[0]))))


def draw_truncation_against_rounding(
    plotted: Sequence[LogarithmicLine], marks: Sequence[LabelledAbscissa], ax: Any = None
) -> Figure:
    """Draw the lines on logarithmic axes, with a dashed vertical line and a label for each mark.

    `ax`: the caller's axes, which have the legend inside; without them a new figure is made.
    """
    figure, axes = canvas_on(ax, _PARTS_HEIGHT)
    for index, line in enumerate(plotted):
        plot_line(axes, line, line_style(index, len(plotted)))
    axes.margins(x=0.05, y=0.06)
    mark_places(axes, sorted(marks), _CROSSOVER_WIDTH)
    draw_grid(axes)
    set_decade_ticks(axes.xaxis, max_ticks=7)
    set_decade_ticks(axes.yaxis)
    axes.set_xlabel("step size h (logarithmic)")
    axes.set_title("greatest |part of Λ|")
    draw_legend(figure if ax is None else None, axes)
    return figure


# -- the growth law -------------------------------------------------------------------------------


def draw_predicted_against_measured(orbits: Sequence[GrowthLawResult]) -> Figure:
    """Draw (a) |Λ|, predicted lines and measured points, and (b) |relative difference| over h."""
    figure = sheet(_GROWTH_HEIGHT, WIDE)
    left, right = figure.subplots(1, 2)
    for index, orbit in enumerate(orbits):
        style = line_style(index, len(orbits))
        _plot_prediction(left, orbit, style)
        plot_line(right, _growth_line(orbit, "difference"), style)
    _draw_unit_slope(right, [_growth_line(orbit, "difference") for orbit in orbits])
    sizes = [p.step_size for orbit in orbits for p in orbit.predictions]
    for axes in (left, right):
        draw_grid(axes)
        axes.margins(y=0.08)
        set_decade_ticks(axes.yaxis, max_ticks=6)
        set_step_size_axis(axes, sizes)
    left.set_title("(a) |Λ|: points measured, lines predicted")
    right.set_title("(b) |predicted − measured| / |measured|")
    if len(orbits) <= MOST_STYLES:
        draw_legend(figure, left, ncols=5)
    return figure


def _growth_line(
    orbit: GrowthLawResult, quantity: Literal["predicted", "measured", "difference"]
) -> LogarithmicLine:
    """Return the line of a quantity of which a digit is known at each step size."""
    points = ((p.step_size, lg(getattr(p, quantity).value)) for p in orbit.predictions)
    return LogarithmicLine(start(orbit.law), tuple(points))


def _plot_prediction(axes: Any, orbit: GrowthLawResult, style: dict[str, Any]) -> None:
    """Plot the predicted line without marks, and the measured marks without a line."""
    plot_line(axes, _growth_line(orbit, "predicted"), {**style, "marker": None})
    points = {"color": style["color"], "marker": style.get("marker", "o"), "markersize": 5}
    plot_line(axes, _growth_line(orbit, "measured"), {**points, "linestyle": "none"})
    # The legend has one entry for each orbit, the mark on its line.
    line, marks = axes.lines[-2:]
    line.set_label("_")
    marks.set_label("_")
    axes.plot([], [], label=start(orbit.law), **style)


def _draw_unit_slope(axes: Any, lines: Sequence[LogarithmicLine]) -> None:
    """Draw a line of slope 1 above all points, labelled at its left end."""
    points = [(lg(h), y) for line in lines for h, y in line.points]
    if not points:
        return
    ends = min(x for x, _ in points), max(x for x, _ in points)
    height = max(y - x for x, y in points) + _GROWTH_GUIDE_GAP
    axes.plot(ends, [height + x for x in ends], color=INK, alpha=0.55, linewidth=0.9)
    axes.annotate(
        "∝ h", (ends[0], height + ends[0]), xytext=(0, 4), textcoords="offset points",
        ha="left", fontsize=11,
    )  # fmt: skip
