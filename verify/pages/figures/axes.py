"""Axes that several figures share: logarithmic by decades, step sizes, one exponent for all."""

from collections.abc import Sequence
from math import floor, isfinite, log10
from typing import Any

from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator

from verify.pages.figures.logarithm import lg
from verify.pages.figures.svg import INK, SERIES
from verify.pages.text.typography import superscript

MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DASHES = ((), (5, 2), (1.5, 1.5), (6, 2, 1.5, 2), (9, 2), (3, 2), (5, 1.5, 1, 1.5, 1, 1.5), (2, 3))
MOST_STYLES = len(SERIES)

Mark = tuple[float, str]
"""An x, and what stands beside the line there."""

_LABEL_GAP, _LETTER = 0.03, 0.025  # of the axis: room between tick labels, and for a letter
_LINE = 0.075  # of the axes: the height of one line of text
_FAINT = {"color": INK, "alpha": 0.15, "linewidth": 0.6}


def line_style(index: int, count: int) -> dict[str, Any]:
    """Colour, marker and dash of a line; beyond `MOST_STYLES` lines all look alike, and thin."""
    if count > MOST_STYLES:
        return {"color": SERIES[0], "linewidth": 0.8, "alpha": 0.5}
    style: dict[str, Any] = {
        "color": SERIES[index],
        "marker": MARKERS[index],
        "markersize": 5,
        "linewidth": 1.4,
    }
    return style | ({"dashes": DASHES[index]} if DASHES[index] else {})


def grid_lines(axes: Any, which: str = "y") -> None:
    axes.grid(axis=which, **_FAINT)
    axes.set_axisbelow(True)
    axes.tick_params(length=3, width=0.7)


def round_numbers(axes: Any) -> None:
    """Some five round numbers on either axis."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}".replace("-", "−")))


def decades(axis: Any, *, most: int = 7) -> None:
    """Powers of ten as ticks of an axis that shows logarithms."""
    axis.set_major_locator(_Decades(most, integer=True, min_n_ticks=2))
    axis.set_major_formatter(FuncFormatter(_power_of_ten))


class _Decades(MaxNLocator):
    """Whole exponents; 1, 2 and 5 times powers of ten, or 1 … 9, where fewer than two are seen.

    Where these are too few as well, the round numbers between.
    """

    def tick_values(self, vmin: float, vmax: float) -> Any:
        low, high = min(vmin, vmax), max(vmin, vmax)
        for mantissas in ((1,), (1, 2, 5), range(1, 10)):
            whole = range(floor(low), floor(high) + 1)
            places = [n + log10(m) for n in whole for m in mantissas]
            seen = [x for x in places if low <= x <= high]
            if len(seen) > 1:
                return super().tick_values(vmin, vmax) if len(mantissas) == 1 else seen
        n = floor(low)
        between = MaxNLocator(4, steps=[1, 2, 5, 10]).tick_values(10 ** (low - n), 10 ** (high - n))
        return [n + log10(x) for x in between if x > 0]


def _power_of_ten(exponent: float, _: object) -> str:
    """10ⁿ, or a mantissa with it."""
    n = floor(exponent + 1e-9)
    scale = f"10{superscript(n)}"
    mantissa = f"{10 ** (exponent - n):.9g}"
    return scale if mantissa == "1" else f"{mantissa}·{scale}"


def whole_numbers(axis: Any) -> None:
    """Few whole numbers as ticks."""
    axis.set_major_locator(MaxNLocator(6, integer=True, steps=[1, 2, 5, 10], min_n_ticks=2))
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:,g}".replace("-", "−")))


def step_sizes(axes: Any, sizes: Sequence[str]) -> None:
    """The step sizes as ticks of a logarithmic x axis, in units of a power of ten."""
    places = sorted({lg(h): h for h in sizes}.items())
    unit = floor(places[0][0] + 1e-9)
    low, high = places[0][0], places[-1][0]
    span = (high - low) or 1.0
    kept: list[tuple[float, str]] = []
    for place, _ in reversed(places):  # the largest is kept in any case
        label = f"{float(10 ** (place - unit)):.3g}"
        if not kept or kept[-1][0] - place > (_LABEL_GAP + _LETTER * len(label)) * span:
            kept.append((place, label))
    axes.xaxis.set_major_locator(FixedLocator([place for place, _ in reversed(kept)]))
    axes.xaxis.set_major_formatter(FixedFormatter([label for _, label in reversed(kept)]))
    axes.set_xlim(low - 0.05 * span, high + 0.05 * span)
    scale = "" if unit == 0 else f", in units of 10{superscript(unit)}"
    axes.set_xlabel(f"step size h{scale} (logarithmic)")


def time_axis(axes: Any, most: int = 5) -> None:
    axes.xaxis.set_major_locator(MaxNLocator(most, steps=[1, 2, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:,g}".replace("-", "−")))
    axes.set_xlabel("time t")


def scaled_ticks(axis: Any, low: float, high: float) -> None:
    """Few ticks, as x·10ⁿ with one exponent."""
    axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    size = max(abs(low), abs(high))
    power = floor(log10(size)) if size > 0 and isfinite(size) else 0
    if -3 < power < 4:
        power = 0

    def shown(x: float, _: object) -> str:
        mantissa = round(x / 10.0**power, 6)
        if mantissa == 0:
            return "0"
        digits = f"{abs(mantissa):g}"
        if power:
            scale = f"10{superscript(power)}"
            digits = scale if abs(mantissa) == 1 else f"{digits}·{scale}"
        return f"{'−' if mantissa < 0 else ''}{digits}"

    axis.set_major_formatter(FuncFormatter(shown))


def mark_places(axes: Any, places: Sequence[Mark], room: float) -> None:
    """A dashed vertical line at each x, its label on a line of its own above all points.

    `places`: from left to right, so that no line runs through another's label. `room`: what a label
    takes of the axes' width.
    """
    low, high = axes.get_ylim()
    above = _LINE * (len(places) + 0.5)
    axes.set_ylim(low, high + (high - low) * above / (1 - above))
    left, right = axes.get_xlim()
    for row, (x, label) in enumerate(places):
        top = 1 - _LINE * row
        axes.axvline(x, ymax=top, color=INK, alpha=0.6, linewidth=0.9, dashes=(4, 3))
        to_the_right = (right - x) / (right - left) > room
        axes.annotate(
            label, (x, top), xycoords=axes.get_xaxis_transform(),
            xytext=(4 if to_the_right else -4, 0), textcoords="offset points",
            ha="left" if to_the_right else "right", va="top", fontsize=11,
        )  # fmt: skip
