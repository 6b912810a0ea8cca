"""Verdicts in the plane of step size and stiffness, with a panel for each scheme, as SVG."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import draw_grid, set_decade_ticks
from verify.pages.figures.logarithm import lg
from verify.pages.figures.panels import make_panels, name_marks
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.stability import Kind, StabilityMapResult

_COLUMNS = 3
# The height of a panel in points.
_PANEL = 165
# The factor of the marks' areas where several panels stand in a row.
_SMALLER = 0.45
# The margin beyond the first and last point, as a part of the axis.
_ROOM = 0.04

# The marks of the kinds; they differ in shape as well, so that no one depends on colours.
_MARKS: dict[Kind, dict[str, Any]] = {
    "stable": {"marker": ".", "color": SERIES[0], "s": 40},
    "drifts": {"marker": "o", "color": SERIES[2], "s": 20, "facecolors": "none"},
    "unstable: scheme": {"marker": "s", "color": SERIES[1], "s": 26},
    "unstable: arithmetic": {"marker": "X", "color": SERIES[6], "s": 40},
    "escapes": {"marker": "^", "color": SERIES[4], "s": 22},
    "overflow": {"marker": "P", "color": SERIES[3], "s": 36},
    "underflow": {"marker": "v", "color": SERIES[3], "s": 22},
    "sensitive": {"marker": "*", "color": SERIES[5], "s": 30},
    "undecided": {"marker": "+", "color": SERIES[7], "s": 30},
}


def draw_planes(maps: Sequence[StabilityMapResult]) -> Figure:
    """Draw a panel for each scheme, with each cell's verdict and the limit of linear theory.

    All maps have the same step sizes and values, and share their axes and one legend.
    """
    columns = min(len(maps), _COLUMNS)
    figure, panels = make_panels(len(maps), in_a_row=columns, height=_PANEL, legend_height=60)
    size = 1 if columns == 1 else _SMALLER
    for axes, stability_map in zip(panels.flat, maps, strict=False):
        _panel(axes, stability_map, size)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{maps[0].parameter} (logarithmic)")
    for j in range(columns):
        lowest = max(i for i in range(len(panels)) if i * columns + j < len(maps))
        panels[lowest, j].set_xlabel("step size h (logarithmic)")
        panels[lowest, j].tick_params(labelbottom=True)
    name_marks(figure, panels, 5 if columns > 1 else 2)
    return figure


def _panel(axes: Any, stability_map: StabilityMapResult, size: float) -> None:
    xs, ys = [lg(h) for h in stability_map.step_sizes], [lg(v) for v in stability_map.values]
    for kind, mark in _MARKS.items():
        cells = [
            (xs[j], ys[i])
            for i, row in enumerate(stability_map.cells)
            for j, cell in enumerate(row)
            if cell.kind == kind
        ]
        if cells:
            look = {**mark, "s": mark["s"] * size}
            axes.scatter(*zip(*cells, strict=True), label=kind, linewidths=0.9, **look)
    limits = [
        (lg(h), y) for h, y in zip(stability_map.linear, ys, strict=True) if h and float(h) > 0
    ]
    if limits:
        ends = zip(*limits, strict=True)
        axes.plot(*ends, color=INK, linewidth=1.4, label="limit of linear theory")
    _frame(axes, xs, ys)
    axes.set_title(stability_map.scheme)


def _frame(axes: Any, xs: Sequence[float], ys: Sequence[float]) -> None:
    for axis, places, limit in ((axes.xaxis, xs, axes.set_xlim), (axes.yaxis, ys, axes.set_ylim)):
        room = _ROOM * (max(places) - min(places) or 1)
        limit(min(places) - room, max(places) + room)
        set_decade_ticks(axis, max_ticks=6)
    draw_grid(axes)
