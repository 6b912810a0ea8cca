"""ΔJ and Λ along runs, as bands between the least and greatest value in a bucket, as inline SVG.

A bucket is a number of consecutive steps. det J is 1 + ΔJ and is not drawn again. A band that fills
its panel tells nothing; so of the runs of one orbit the shortest shows ΔJ, and the longest Λ.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch

from verify.pages.figures.axes import draw_grid, make_panels, set_scaled_ticks, set_time_axis
from verify.pages.figures.sheet import INK, SERIES
from verify.scenes.results.run import RunResult, SeriesPoint

_MAX_BUCKETS = 600
# The number of ticks on the axis of time.
_TICK_COUNT = 3
# A band that is on average thicker than this part of the panel looks like a rectangle.
_MAX_FILLED_SHARE = 0.5
# The height of a panel in points, and the panels in a row.
_HEIGHT, _IN_A_ROW = 180, 4
Quantity = Literal["delta_j", "lam"]
Band = tuple[float, float]
_STYLES: dict[Quantity, tuple[str, str]] = {"delta_j": ("ΔJ", SERIES[0]), "lam": ("Λ", SERIES[2])}


@dataclass(frozen=True)
class OrbitPanels:
    """The panels of one orbit: runs, each with the quantity that it shows."""

    label: str
    panels: tuple[tuple[RunResult, Quantity], ...]


def select_panels(label: str, runs: Sequence[RunResult]) -> OrbitPanels:
    """Return ΔJ of the shortest run, unless its band fills its panel, and Λ of the longest."""
    by_length = sorted(runs, key=lambda run: run.steps)
    shortest, longest = by_length[0], by_length[-1]
    panels: list[tuple[RunResult, Quantity]] = [(longest, "lam")]
    if not is_filled(shortest, "delta_j"):
        panels.insert(0, (shortest, "delta_j"))
    return OrbitPanels(label, tuple(panels))


def is_filled(run: RunResult, quantity: Quantity) -> bool:
    """Return True if the band would fill its panel, as values that oscillate in each bucket do."""
    bands = [_band(getattr(point, quantity)) for point in merge_buckets(run.series)]
    if max(point.last - point.first for point in merge_buckets(run.series)) == 0:
        return False  # each bucket is a single step, and the band is a line
    reach = max(high for _, high in bands) - min(low for low, _ in bands)
    return reach > 0 and sum(high - low for low, high in bands) > _MAX_FILLED_SHARE * reach * len(
        bands
    )


def draw_over_time(rows: Sequence[OrbitPanels]) -> Figure:
    """Draw the panels of each orbit side by side, with its name if there are several."""
    several = len(rows) > 1
    panels = [(run, quantity, row.label * several) for row in rows for run, quantity in row.panels]
    figure, all_axes = make_panels(
        len(panels), in_a_row=_IN_A_ROW, height=_HEIGHT, legend_height=10, shared=False
    )
    for axes, (run, quantity, label) in zip(all_axes.flat, panels, strict=False):
        _panel(axes, run, quantity, label)
    return figure


def _panel(axes: Any, run: RunResult, quantity: Quantity, label: str) -> None:
    points = merge_buckets(run.series)
    h = float(Fraction(run.step_size))
    steps = (points[0].first - 1, *(point.last for point in points))
    edges = [float(Fraction(run.t0)) + n * h for n in steps]
    name, colour = _STYLES[quantity]
    _draw_band(axes, edges, [_band(getattr(point, quantity)) for point in points], colour)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_title(f"{name}, {label}" if label else name)
    set_time_axis(axes, _TICK_COUNT)


def _band(ends: tuple[str, str]) -> Band:
    return float(ends[0]), float(ends[1])


def _draw_band(axes: Any, edges: Sequence[float], band: Sequence[Band], colour: str) -> None:
    low: Any = [b[0] for b in band]  # matplotlib's type allows a single number only
    high = [b[1] for b in band]
    fill = to_rgba(colour, 0.3)
    # `Axes.stairs` would examine every vertex for the limits, which are set below.
    axes.add_artist(
        StepPatch(high, edges, baseline=low, facecolor=fill, edgecolor=colour, linewidth=0.9)
    )
    least, greatest = min(0.0, *low), max(0.0, *high)
    margin = 0.08 * (greatest - least) or 1.0
    axes.set_ylim(least - margin, greatest + margin)
    axes.axhline(0, color=INK, alpha=0.6, linewidth=0.7)
    draw_grid(axes)
    set_scaled_ticks(axes.yaxis, least, greatest)


def merge_buckets(series: Sequence[SeriesPoint], most: int = _MAX_BUCKETS) -> list[SeriesPoint]:
    """Return at most `most` buckets, by merging neighbours, with the extremes of those merged."""
    size = -(-len(series) // most)
    if size <= 1:
        return list(series)
    groups = (series[i : i + size] for i in range(0, len(series), size))
    return [_merge_group(group) for group in groups]


def _merge_group(group: Sequence[SeriesPoint]) -> SeriesPoint:
    return SeriesPoint(
        first=group[0].first,
        last=group[-1].last,
        delta_j=_hull([p.delta_j for p in group]),
        lam=_hull([p.lam for p in group]),
        energy=group[-1].energy,
    )


def _hull(bands: Sequence[tuple[str, str]]) -> tuple[str, str]:
    return min((b[0] for b in bands), key=float), max((b[1] for b in bands), key=float)
