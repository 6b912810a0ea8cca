"""Verdicts in the plane of step size and stiffness, one scheme a picture, as inline SVG."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import decades, grid_lines
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import canvas
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.stability import Kind, StabilityMapResult

_HEIGHT = 380
_LEGEND = 2  # columns
_ROOM = 0.04  # of an axis, beyond its first and last point

# What a kind looks like; shapes differ as well as colours.
_MARKS: dict[Kind, dict[str, Any]] = {
    "stable": {"marker": ".", "color": SERIES[0], "s": 12},
    "drifts": {"marker": "o", "color": SERIES[2], "s": 20, "facecolors": "none"},
    "unstable: scheme": {"marker": "s", "color": SERIES[1], "s": 26},
    "unstable: arithmetic": {"marker": "X", "color": SERIES[6], "s": 40},
    "escapes": {"marker": "^", "color": SERIES[4], "s": 22},
    "overflow": {"marker": "P", "color": SERIES[3], "s": 36},
    "underflow": {"marker": "v", "color": SERIES[3], "s": 22},
    "undecided": {"marker": "+", "color": SERIES[7], "s": 30},
}


def draw_plane(over: StabilityMapResult) -> Figure:
    """Each cell by its verdict's mark; the line is linear theory's step size."""
    figure, axes = canvas(_HEIGHT)
    xs, ys = [lg(h) for h in over.step_sizes], [lg(v) for v in over.values]
    for kind, mark in _MARKS.items():
        cells = [
            (xs[j], ys[i])
            for i, row in enumerate(over.cells)
            for j, cell in enumerate(row)
            if cell.kind == kind
        ]
        if cells:
            axes.scatter(*zip(*cells, strict=True), label=kind, linewidths=0.9, **mark)
    limits = [(lg(h), y) for h, y in zip(over.linear, ys, strict=True) if h and float(h) > 0]
    if limits:
        ends = zip(*limits, strict=True)
        axes.plot(*ends, color=INK, linewidth=1.4, label="limit of linear theory")
    _frame(axes, xs, ys, over.parameter)
    figure.legend(loc="outside lower center", ncols=_LEGEND, handlelength=1.6)
    return figure


def _frame(axes: Any, xs: Sequence[float], ys: Sequence[float], parameter: str) -> None:
    for axis, places, limit in ((axes.xaxis, xs, axes.set_xlim), (axes.yaxis, ys, axes.set_ylim)):
        room = _ROOM * (max(places) - min(places) or 1)
        limit(min(places) - room, max(places) + room)
        decades(axis, most=6)
    grid_lines(axes)
    axes.set_xlabel("step size h (logarithmic)")
    axes.set_ylabel(f"{parameter} (logarithmic)")
