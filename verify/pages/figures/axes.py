"""Axes that figures share, with ticks by decades, step sizes or times; and rows of panels."""

from collections.abc import Sequence
from math import floor, isfinite, log10
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator

from verify.pages.figures.captioned_plot import lg
from verify.pages.figures.sheet import INK, NARROW, SERIES, WIDE, sheet
from verify.pages.text.typography import superscript

MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DASHES = ((), (5, 2), (1.5, 1.5), (6, 2, 1.5, 2), (9, 2), (3, 2), (5, 1.5, 1, 1.5, 1, 1.5), (2, 3))
MOST_STYLES = len(SERIES)

LabelledAbscissa = tuple[float, str]
"""An abscissa, and the label beside the line there."""

# The gap between tick labels and the width of a letter, as parts of the axis.
_LABEL_GAP, _LETTER_WIDTH = 0.03, 0.025
# The height of a line of text, as a part of the axes.
_LINE_HEIGHT = 0.075
_GRID_STYLE = {"color": INK, "alpha": 0.15, "linewidth": 0.6}


def line_style(index: int, count: int) -> dict[str, Any]:
    """Return colour, marker and dash of a line of `count`; beyond `MOST_STYLES` all look alike."""
    if count > MOST_STYLES:
        return {"color": SERIES[0], "linewidth": 0.8, "alpha": 0.5}
    style: dict[str, Any] = {
        "color": SERIES[index],
        "marker": MARKERS[index],
        "markersize": 5,
        "linewidth": 1.4,
    }
    return style | ({"dashes": DASHES[index]} if DASHES[index] else {})


def draw_grid(axes: Any, direction: str = "y") -> None:
    """Draw faint grid lines behind the data and shorten the ticks."""
    axes.grid(axis=direction, **_GRID_STYLE)
    axes.set_axisbelow(True)
    axes.tick_params(length=3, width=0.7)


def set_round_ticks(axes: Any) -> None:
    """Set about five round numbers as ticks on either axis."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}".replace("-", "−")))


def set_decade_ticks(axis: Any, *, max_ticks: int = 7) -> None:
    """Set powers of ten as ticks of an axis whose data are logarithms."""
    axis.set_major_locator(_Decades(max_ticks, integer=True, min_n_ticks=2))
    axis.set_major_formatter(FuncFormatter(_power_of_ten))


class _Decades(MaxNLocator):
    """A locator of whole exponents, of which at least two must be visible.

    If they are not, it takes 1, 2 and 5 times powers of ten, else 1 … 9 times, else round numbers.
    """

    def tick_values(self, vmin: float, vmax: float) -> Any:
        low, high = min(vmin, vmax), max(vmin, vmax)
        for mantissas in ((1,), (1, 2, 5), range(1, 10)):
            exponents = range(floor(low), floor(high) + 1)
            ticks = [n + log10(m) for n in exponents for m in mantissas]
            visible = [x for x in ticks if low <= x <= high]
            if len(visible) > 1:
                return super().tick_values(vmin, vmax) if len(mantissas) == 1 else visible
        n = floor(low)
        round_numbers = MaxNLocator(4, steps=[1, 2, 5, 10]).tick_values(
            10 ** (low - n), 10 ** (high - n)
        )
        return [n + log10(x) for x in round_numbers if x > 0]


def _power_of_ten(exponent: float, _: object) -> str:
    """Return m·10ⁿ as text, without the mantissa m if it is 1."""
    # A tick may be a little below a whole exponent by rounding.
    n = floor(exponent + 1e-9)
    scale = f"10{superscript(n)}"
    mantissa = f"{10 ** (exponent - n):.9g}"
    return scale if mantissa == "1" else f"{mantissa}·{scale}"


def set_whole_number_ticks(axis: Any) -> None:
    """Set a few whole numbers as ticks."""
    axis.set_major_locator(MaxNLocator(6, integer=True, steps=[1, 2, 5, 10], min_n_ticks=2))
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:,g}".replace("-", "−")))


def set_step_size_axis(axes: Any, sizes: Sequence[str]) -> None:
    """Set the step sizes as ticks of an x axis of logarithms, in units of a power of ten."""
    sizes_by_lg = sorted({lg(h): h for h in sizes}.items())
    unit = floor(sizes_by_lg[0][0] + 1e-9)
    low, high = sizes_by_lg[0][0], sizes_by_lg[-1][0]
    span = (high - low) or 1.0
    labels: list[tuple[float, str]] = []
    # From right to left: the largest step size always has a label, another one if there is room.
    for tick, _ in reversed(sizes_by_lg):
        label = f"{float(10 ** (tick - unit)):.3g}"
        if not labels or labels[-1][0] - tick > (_LABEL_GAP + _LETTER_WIDTH * len(label)) * span:
            labels.append((tick, label))
    axes.xaxis.set_major_locator(FixedLocator([tick for tick, _ in reversed(labels)]))
    axes.xaxis.set_major_formatter(FixedFormatter([label for _, label in reversed(labels)]))
    axes.set_xlim(low - 0.05 * span, high + 0.05 * span)
    scale = "" if unit == 0 else f", in units of 10{superscript(unit)}"
    axes.set_xlabel(f"step size h{scale} (logarithmic)")


def set_time_axis(axes: Any, max_ticks: int = 5) -> None:
    """Set round times as ticks of the x axis."""
    axes.xaxis.set_major_locator(MaxNLocator(max_ticks, steps=[1, 2, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:,g}".replace("-", "−")))
    axes.set_xlabel("time t")


def set_scaled_ticks(axis: Any, low: float, high: float) -> None:
    """Set a few ticks, written as x·10ⁿ with the same n for all."""
    axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    size = max(abs(low), abs(high))
    # Numbers between 0.001 and 10,000 are readable without a power of ten.
    power = floor(log10(size)) if size > 0 and isfinite(size) else 0
    if -3 < power < 4:
        power = 0

    def format_tick(x: float, _: object) -> str:
        mantissa = round(x / 10.0**power, 6)
        if mantissa == 0:
            return "0"
        digits = f"{abs(mantissa):g}"
        if power:
            scale = f"10{superscript(power)}"
            digits = scale if abs(mantissa) == 1 else f"{digits}·{scale}"
        return f"{'−' if mantissa < 0 else ''}{digits}"

    axis.set_major_formatter(FuncFormatter(format_tick))


def mark_places(axes: Any, labels: Sequence[LabelledAbscissa], room: float) -> None:
    """Draw a dashed vertical line at each abscissa, its label in a row of its own above all points.

    `labels`: from left to right, so that no line crosses the label of another. `room`: the width of
    a label as a part of the axes' width.
    """
    # The range grows by a part x of itself with x/(1 + x) = label_share, where the labels stand.
    low, high = axes.get_ylim()
    label_share = _LINE_HEIGHT * (len(labels) + 0.5)
    axes.set_ylim(low, high + (high - low) * label_share / (1 - label_share))
    left, right = axes.get_xlim()
    for row, (x, label) in enumerate(labels):
        label_top = 1 - _LINE_HEIGHT * row
        axes.axvline(x, ymax=label_top, color=INK, alpha=0.6, linewidth=0.9, dashes=(4, 3))
        to_the_right = (right - x) / (right - left) > room
        axes.annotate(
            label, (x, label_top), xycoords=axes.get_xaxis_transform(),
            xytext=(4 if to_the_right else -4, 0), textcoords="offset points",
            ha="left" if to_the_right else "right", va="top", fontsize=11,
        )  # fmt: skip


# -- panels side by side --------------------------------------------------------------------------


def make_panels(
    count: int, *, in_a_row: int, height: float, legend_height: float = 0, shared: bool = True
) -> tuple[Figure, Any]:
    """Return a figure with `count` panels in rows of `height`, and an array of all their axes.

    Places without a panel show no axes. `legend_height`: the height of the legend below the panels;
    `shared`: True if all panels have the same limits.
    """
    columns = min(count, in_a_row)
    rows = -(-count // columns)
    figure = sheet(height * rows + legend_height, WIDE if columns > 1 else NARROW)
    panels: Any = figure.subplots(rows, columns, sharex=shared, sharey=shared, squeeze=False)
    for axes in panels.flat[count:]:
        axes.set_axis_off()
    return figure, panels


def name_states(
    panels: Any, titles: Sequence[str], coordinates: Sequence[str], room: float
) -> None:
    """Set the panels' titles, the names of their coordinates, round ticks and a grid."""
    for axes, title in zip(panels.flat, titles, strict=False):
        axes.set_title(title)
        axes.set_xlabel(coordinates[0])
        axes.margins(room)
        set_round_ticks(axes)
        axes.tick_params(labelbottom=True)
        draw_grid(axes, "both")
    for row in panels:
        row[0].set_ylabel(coordinates[1], rotation=0, labelpad=10)


def name_marks(figure: Figure, panels: Any, ncols: int) -> None:
    """Set one legend below all panels, with one entry for each label."""
    handles = {
        label: handle
        for axes in panels.flat
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(
        handles.values(), handles, loc="outside lower center", ncols=ncols, handlelength=1.6
    )
