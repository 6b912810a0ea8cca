"""The figures: what a scene's runs, series and printed tables show, as inline SVG.

Logarithms are taken in decimals before anything is drawn, so that 1e-500 has its place too; what is
not known (no digit of it) or is zero has no place on a logarithmic axis and is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    MOST_STYLES,
    decades,
    grid_lines,
    line_style,
    offset_ticks,
    step_sizes,
    time_axis,
    whole_numbers,
)
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import canvas, canvas_on, legend, sheet
from verify.pages.figures.svg import INK, SERIES
from verify.pages.text.typography import power_of_h, start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult, SeriesPoint

_MOST_BUCKETS = 600
_LABEL_WIDTH, _LABEL_HEIGHT = 0.1, 0.08  # of the axes: the room for a guide's label
_GUIDE_GAP = 0.35  # decades between a slope guide and the line that it is nearest to


@dataclass(frozen=True)
class Line:
    """One line of a logarithmic plot: (step size, lg of the quantity) by step size."""

    label: str
    points: tuple[tuple[str, float], ...]


# -- the data of a plot ---------------------------------------------------------------------------


def lines(runs: Sequence[RunResult], above: str, below: str = "") -> list[Line]:
    """One line an initial value: lg |values[above]|, or lg |values[above] / values[below]|."""

    def place(run: RunResult) -> float:
        return _lg(run.values.get(above)) - (_lg(run.values.get(below)) if below else 0)

    return lines_of(runs, place)


def lines_of(runs: Sequence[RunResult], place: Callable[[RunResult], float]) -> list[Line]:
    """One line an initial value, of what is finite of the places."""
    groups: dict[str, list[tuple[str, float]]] = {}
    for run in sorted(runs, key=lambda run: Fraction(run.step_size)):
        at = place(run)
        if isfinite(at):
            groups.setdefault(start(run), []).append((run.step_size, at))
    found = {start(run): groups.get(start(run), []) for run in runs}
    return [Line(label, tuple(points)) for label, points in found.items() if len(points) > 1]


def _lg(found: Value | None) -> float:
    return lg(found.value) if found else float("nan")


# -- against the step size ------------------------------------------------------------------------


def draw_against_step_size(
    plotted: Sequence[Line], quantity: str, guides: Sequence[int], ax: Any = None
) -> Figure:
    """The lines on logarithmic axes, with a grey guide for each slope in `guides`.

    `ax`: axes of the caller's, with the legend inside; a figure of its own without them.
    """
    figure, axes = canvas_on(ax, 330 if len(plotted) <= MOST_STYLES else 280)
    for index, line in enumerate(plotted):
        plot_line(axes, line, line_style(index, len(plotted)))
    _guides(axes, plotted, guides)
    _finish(figure if ax is None else None, axes, plotted)
    decades(axes.yaxis)
    axes.set_title(quantity)
    return figure


def draw_printed_against_computed(computed: Sequence[Line], printed: Line) -> Figure:
    """lg MSE as it is printed and as it is computed."""
    figure, axes = canvas(350)
    plot_line(axes, printed, {"color": INK, "linewidth": 3})
    for index, line in enumerate(computed):
        plot_line(axes, line, line_style(index, len(computed)))
    _finish(figure, axes, [printed, *computed])
    whole_numbers(axes.yaxis)
    axes.set_title("lg MSE")
    return figure


def plot_line(axes: Any, line: Line, style: dict[str, Any]) -> None:
    x, y = [lg(h) for h, _ in line.points], [place for _, place in line.points]
    axes.plot(x, y, label=line.label, **style)


def _finish(figure: Figure | None, axes: Any, plotted: Sequence[Line]) -> None:
    step_sizes(axes, [h for line in plotted for h, _ in line.points])
    grid_lines(axes)
    axes.margins(y=0.08)
    if len(plotted) <= MOST_STYLES + 1:
        legend(figure, axes, ncols=2)


def _guides(axes: Any, plotted: Sequence[Line], slopes: Sequence[int]) -> None:
    """Straight lines of these slopes above all points, labelled at the end where they part."""
    if not slopes:
        return
    points = [(lg(h), y) for line in plotted for h, y in line.points]
    ends = min(x for x, _ in points), max(x for x, _ in points)
    heights = {s: max(y - s * x for x, y in points) + _GUIDE_GAP for s in slopes}
    parted = [max(at) - min(at) for at in ([c + s * x for s, c in heights.items()] for x in ends)]
    left = parted[0] >= parted[1]
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


# -- over time ------------------------------------------------------------------------------------


def draw_over_time(run: RunResult) -> Figure:
    """det J, ΔJ and Λ over t, each as the band between its least and greatest in a bucket."""
    points = merged(run.series)
    h = float(Fraction(run.step_size))
    edges = [(points[0].first - 1) * h, *(point.last * h for point in points)]
    delta_j = [_band(p.delta_j) for p in points]
    lam = [_band(p.lam) for p in points]
    panels = [("det J", delta_j, True), ("ΔJ", delta_j, False), ("Λ", lam, False)]
    figure = sheet(400)
    all_axes = figure.subplots(len(panels), 1, sharex=True)
    for index, (axes, (title, band, around_one)) in enumerate(zip(all_axes, panels, strict=True)):
        _panel(axes, edges, band, SERIES[2 if title == "Λ" else 0], around_one)
        axes.set_title(f"({'abc'[index]}) {title}")
    axes.set_xlim(edges[0], edges[-1])
    time_axis(axes)
    return figure


def _band(ends: tuple[str, str]) -> tuple[float, float]:
    return float(ends[0]), float(ends[1])


def _panel(
    axes: Any,
    edges: Sequence[float],
    band: Sequence[tuple[float, float]],
    colour: str,
    around_one: bool,
) -> None:
    low, high = [b[0] for b in band], [b[1] for b in band]
    fill = to_rgba(colour, 0.3)
    axes.stairs(
        high, edges, baseline=low, fill=True, facecolor=fill, edgecolor=colour, linewidth=0.9
    )
    bottom, top = min(0.0, *low), max(0.0, *high)
    room = 0.08 * (top - bottom) or 1.0
    axes.set_ylim(bottom - room, top + room)
    axes.axhline(0, color=INK, alpha=0.6, linewidth=0.7)
    grid_lines(axes)
    offset_ticks(axes.yaxis, bottom, top, around_one=around_one)


def merged(series: Sequence[SeriesPoint], most: int = _MOST_BUCKETS) -> list[SeriesPoint]:
    """At most `most` buckets, neighbours put together; their extremes stay extremes."""
    size = -(-len(series) // most)
    if size <= 1:
        return list(series)
    groups = (series[i : i + size] for i in range(0, len(series), size))
    return [_together(group) for group in groups]


def _together(group: Sequence[SeriesPoint]) -> SeriesPoint:
    return SeriesPoint(
        first=group[0].first,
        last=group[-1].last,
        delta_j=_hull([p.delta_j for p in group]),
        lam=_hull([p.lam for p in group]),
    )


def _hull(bands: Sequence[tuple[str, str]]) -> tuple[str, str]:
    return min((b[0] for b in bands), key=float), max((b[1] for b in bands), key=float)
