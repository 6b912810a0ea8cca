"""What runs show against their step sizes, and printed tables beside them, as inline SVG.

Logarithms are taken in decimals before anything is drawn, so that 1e-500 has its place too; what is
not known (no digit of it) or is zero has no place on a logarithmic axis and is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    MOST_STYLES,
    decades,
    grid_lines,
    line_style,
    step_sizes,
    whole_numbers,
)
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import NARROW, WIDE, canvas, legend, sheet
from verify.pages.figures.svg import INK
from verify.pages.text.typography import power_of_h, start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

_PANEL = 230  # points high, with the legend
_LABEL_WIDTH, _LABEL_HEIGHT = 0.1, 0.08  # of the axes: the room for a guide's label
MOST_LINES = 120  # drawn in one panel, beyond which none can be told from its neighbours
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


def thinned(found: Sequence[Line], most: int = MOST_LINES) -> list[Line]:
    """So many of the lines at most, in their order: by their height, evenly, both ends included.

    >>> [x.label for x in thinned([Line(str(k), (("1", k % 5),)) for k in range(5)], most=3)]
    ['0', '2', '4']
    """
    if len(found) <= most:
        return list(found)
    by_height = sorted(range(len(found)), key=lambda k: max(y for _, y in found[k].points))
    places = {by_height[k * (len(found) - 1) // (most - 1)] for k in range(most)}
    return [line for k, line in enumerate(found) if k in places]


def _lg(found: Value | None) -> float:
    return lg(found.value) if found else float("nan")


# -- against the step size ------------------------------------------------------------------------


@dataclass(frozen=True)
class Quantity:
    """What is drawn over h: its lines, and a grey guide for each power of h in `guides`."""

    title: str
    lines: Sequence[Line]
    guides: Sequence[int] = ()


def draw_against_step_size(shown: Sequence[Quantity], ax: Any = None) -> Figure:
    """A panel for each quantity on logarithmic axes, beside one another, with one legend.

    `ax`: axes of the caller's for a single quantity, with the legend inside; a figure of its own
    without them.
    """
    labels = list(dict.fromkeys(line.label for each in shown for line in each.lines))
    figure = ax.figure if ax else sheet(_PANEL, WIDE if len(shown) > 1 else NARROW)
    panels = [ax] if ax else figure.subplots(1, len(shown), squeeze=False)[0]
    for axes, each in zip(panels, shown, strict=True):
        for line in each.lines:
            plot_line(axes, line, line_style(labels.index(line.label), len(labels)))
        _guides(axes, each.lines, each.guides)
        _frame(axes, each.lines)
        decades(axes.yaxis)
        axes.set_title(each.title)
    if len(labels) <= MOST_STYLES + 1:
        fullest = max(panels, key=lambda axes: len(axes.get_legend_handles_labels()[1]))
        legend(None if ax else figure, fullest, ncols=2 if len(shown) == 1 else 5)
    return figure


def draw_printed_against_computed(computed: Sequence[Line], printed: Line) -> Figure:
    """lg MSE as it is printed and as it is computed."""
    figure, axes = canvas(350)
    plot_line(axes, printed, {"color": INK, "linewidth": 3})
    for index, line in enumerate(computed):
        plot_line(axes, line, line_style(index, len(computed)))
    _frame(axes, [printed, *computed])
    legend(figure, axes, ncols=2)
    whole_numbers(axes.yaxis)
    axes.set_title("lg MSE")
    return figure


def plot_line(axes: Any, line: Line, style: dict[str, Any]) -> None:
    x, y = [lg(h) for h, _ in line.points], [place for _, place in line.points]
    axes.plot(x, y, label=line.label, **style)


def _frame(axes: Any, plotted: Sequence[Line]) -> None:
    step_sizes(axes, [h for line in plotted for h, _ in line.points])
    grid_lines(axes)
    axes.margins(y=0.08)


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
