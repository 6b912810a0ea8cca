"""H − H₀ along runs over time, a panel for each scheme, as inline SVG."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import draw_grid, make_panels, set_scaled_ticks, set_time_axis
from verify.pages.figures.over_time_figure import merge_buckets
from verify.pages.figures.sheet import INK, SERIES
from verify.scenes.results.run import RunResult

_HEIGHT, _IN_A_ROW = 180, 4
_TICK_COUNT = 3
_MAX_LABEL = 26


def draw_energy(runs: Sequence[RunResult]) -> Figure:
    """Draw the energy error of each run in a panel with limits of its own."""
    figure, all_axes = make_panels(
        len(runs), in_a_row=_IN_A_ROW, height=_HEIGHT, legend_height=10, shared=False
    )
    for axes, run in zip(all_axes.flat, runs, strict=False):
        _panel(axes, run)
    return figure


def _panel(axes: Any, run: RunResult) -> None:
    t0, h = float(Fraction(run.t0)), float(Fraction(run.step_size))
    points = [(x.last, float(x.energy)) for x in merge_buckets(run.series) if x.energy is not None]
    times = [t0, *(t0 + n * h for n, _ in points)]
    errors = [0.0, *(error for _, error in points)]
    axes.plot(times, errors, color=SERIES[1], linewidth=0.9)
    axes.axhline(0, color=INK, alpha=0.6, linewidth=0.7)
    least, greatest = min(errors), max(errors)
    margin = 0.08 * (greatest - least) or 1.0
    axes.set_xlim(times[0], times[-1])
    axes.set_ylim(least - margin, greatest + margin)
    title = run.scheme_title
    name = title if len(title) <= _MAX_LABEL else f"{title[:_MAX_LABEL]}…"
    axes.set_title(f"H − H₀, {name}" if len(name) < _MAX_LABEL - 6 else name)
    draw_grid(axes)
    set_scaled_ticks(axes.yaxis, least, greatest)
    set_time_axis(axes, _TICK_COUNT)
