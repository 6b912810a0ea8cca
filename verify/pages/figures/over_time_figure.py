"""ΔJ and Λ along runs, each as the band between its least and greatest in a bucket, as inline SVG.

det J is 1 + ΔJ, and is not drawn again. A band that fills its panel says nothing about what is
within it: of two runs of one orbit the shorter one shows ΔJ then, the longer one Λ.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch

from verify.pages.figures.axes import grid_lines, scaled_ticks, time_axis
from verify.pages.figures.panels import panels_beside
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.run import RunResult, SeriesPoint

_MOST_BUCKETS = 600
_TICKS = 3  # steps on the axis of time
_FILLED = 0.5  # of the panel: a band that is thicker on the average is a rectangle to the eye
_HEIGHT, _IN_A_ROW = 180, 4  # of a panel, in points; panels
Quantity = Literal["delta_j", "lam"]
Band = tuple[float, float]
_SHOWN: dict[Quantity, tuple[str, str]] = {"delta_j": ("ΔJ", SERIES[0]), "lam": ("Λ", SERIES[2])}


@dataclass(frozen=True)
class Along:
    """What is drawn of one orbit: each run with the quantity that it shows."""

    label: str
    panels: tuple[tuple[RunResult, Quantity], ...]


def along(label: str, runs: Sequence[RunResult]) -> Along:
    """ΔJ of the shortest run, unless its band is filled, and Λ of the longest."""
    by_length = sorted(runs, key=lambda run: run.steps)
    near, far = by_length[0], by_length[-1]
    panels: list[tuple[RunResult, Quantity]] = [(far, "lam")]
    if not is_filled(near, "delta_j"):
        panels.insert(0, (near, "delta_j"))
    return Along(label, tuple(panels))


def is_filled(run: RunResult, quantity: Quantity) -> bool:
    """Whether the drawing would be a rectangle: buckets in which the values go up and down."""
    bands = [_band(getattr(point, quantity)) for point in merged(run.series)]
    if max(point.last - point.first for point in merged(run.series)) == 0:
        return False
    reach = max(high for _, high in bands) - min(low for low, _ in bands)
    return reach > 0 and sum(high - low for low, high in bands) > _FILLED * reach * len(bands)


def draw_over_time(rows: Sequence[Along]) -> Figure:
    """The panels of each orbit beside one another, with its name where there are several."""
    several = len(rows) > 1
    panels = [(run, quantity, row.label * several) for row in rows for run, quantity in row.panels]
    figure, all_axes = panels_beside(
        len(panels), in_a_row=_IN_A_ROW, height=_HEIGHT, beside=10, shared=False
    )
    for axes, (run, quantity, label) in zip(all_axes.flat, panels, strict=False):
        _panel(axes, run, quantity, label)
    return figure


def _panel(axes: Any, run: RunResult, quantity: Quantity, label: str) -> None:
    points = merged(run.series)
    h = float(Fraction(run.step_size))
    steps = (points[0].first - 1, *(point.last for point in points))
    edges = [float(Fraction(run.t0)) + n * h for n in steps]
    name, colour = _SHOWN[quantity]
    _draw_band(axes, edges, [_band(getattr(point, quantity)) for point in points], colour)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_title(f"{name}, {label}" if label else name)
    time_axis(axes, _TICKS)


def _band(ends: tuple[str, str]) -> Band:
    return float(ends[0]), float(ends[1])


def _draw_band(axes: Any, edges: Sequence[float], band: Sequence[Band], colour: str) -> None:
    low: Any = [b[0] for b in band]  # matplotlib's types know one number alone
    high = [b[1] for b in band]
    fill = to_rgba(colour, 0.3)
    # `Axes.stairs` looks at every vertex for limits, which are set here.
    axes.add_artist(
        StepPatch(high, edges, baseline=low, facecolor=fill, edgecolor=colour, linewidth=0.9)
    )
    bottom, top = min(0.0, *low), max(0.0, *high)
    room = 0.08 * (top - bottom) or 1.0
    axes.set_ylim(bottom - room, top + room)
    axes.axhline(0, color=INK, alpha=0.6, linewidth=0.7)
    grid_lines(axes)
    scaled_ticks(axes.yaxis, bottom, top)


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
