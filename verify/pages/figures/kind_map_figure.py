"""Kinds of motion as marks over two inputs, with a panel for each scheme.

For runs the inputs are the step size and a parameter, on logarithmic axes; for orbits, two initial
values.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    draw_grid,
    make_panels,
    name_marks,
    name_states,
    set_decade_ticks,
)
from verify.pages.figures.captioned_plot import lg
from verify.pages.figures.sheet import INK, NARROW, SERIES, WIDE
from verify.scenes.results.stability import Kind, OrbitKind, OrbitMapResult, StabilityMapResult

_IN_A_ROW = 3
# The heights in points of a panel of runs and of one of orbits, and of the legends below them.
_RUN_HEIGHT, _ORBIT_HEIGHT = 165, 250
_RUN_LEGEND, _ORBIT_LEGEND = 60, 40
# The factor of the marks' areas if several panels of runs stand in a row.
_AREA_FACTOR = 0.45
# The margin beyond the first and last point, as a part of the axis.
_MARGIN = 0.04
# The number of lines of equal energy.
_CONTOUR_COUNT = 6

# The marks of the kinds. They differ in shape as well, for readers who cannot see the colours.
_RUN_MARKS: dict[Kind, dict[str, Any]] = {
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
_ORBIT_MARKS: dict[OrbitKind, dict[str, Any]] = {
    "regular": {"marker": ".", "color": SERIES[0]},
    "sensitive": {"marker": "s", "color": SERIES[1]},
    "undecided": {"marker": "+", "color": SERIES[7]},
    "leaves": {"marker": "^", "color": SERIES[4], "facecolors": "none", "alpha": 0.5},
}


# -- runs over step size and stiffness ------------------------------------------------------------


def draw_planes(maps: Sequence[StabilityMapResult]) -> Figure:
    """Draw a panel for each scheme, with each cell's verdict and the limit of linear theory.

    All maps have the same step sizes and values, and share their axes and one legend.
    """
    columns = min(len(maps), _IN_A_ROW)
    figure, panels = make_panels(
        len(maps), in_a_row=columns, height=_RUN_HEIGHT, legend_height=_RUN_LEGEND
    )
    area_factor = 1 if columns == 1 else _AREA_FACTOR
    for axes, stability_map in zip(panels.flat, maps, strict=False):
        _draw_runs(axes, stability_map, area_factor)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{maps[0].parameter} (logarithmic)")
    for j in range(columns):
        lowest_row = max(i for i in range(len(panels)) if i * columns + j < len(maps))
        panels[lowest_row, j].set_xlabel("step size h (logarithmic)")
        panels[lowest_row, j].tick_params(labelbottom=True)
    name_marks(figure, panels, 5 if columns > 1 else 2)
    return figure


def _draw_runs(axes: Any, stability_map: StabilityMapResult, area_factor: float) -> None:
    xs, ys = [lg(h) for h in stability_map.step_sizes], [lg(v) for v in stability_map.values]
    for kind, mark in _RUN_MARKS.items():
        cells = [
            (xs[j], ys[i])
            for i, row in enumerate(stability_map.cells)
            for j, cell in enumerate(row)
            if cell.kind == kind
        ]
        if cells:
            look = {**mark, "s": mark["s"] * area_factor}
            axes.scatter(*zip(*cells, strict=True), label=kind, linewidths=0.9, **look)
    limits = [
        (lg(h), y) for h, y in zip(stability_map.linear, ys, strict=True) if h and float(h) > 0
    ]
    if limits:
        coordinates = zip(*limits, strict=True)
        axes.plot(*coordinates, color=INK, linewidth=1.4, label="limit of linear theory")
    _frame(axes, xs, ys)
    axes.set_title(stability_map.scheme_title)


def _frame(axes: Any, xs: Sequence[float], ys: Sequence[float]) -> None:
    for axis, coordinates, set_limits in (
        (axes.xaxis, xs, axes.set_xlim),
        (axes.yaxis, ys, axes.set_ylim),
    ):
        margin = _MARGIN * (max(coordinates) - min(coordinates) or 1)
        set_limits(min(coordinates) - margin, max(coordinates) + margin)
        set_decade_ticks(axis, max_ticks=6)
    draw_grid(axes)


# -- orbits over two initial values ---------------------------------------------------------------


def draw_orbit_maps(maps: Sequence[OrbitMapResult]) -> Figure:
    """Draw each orbit by the mark of its kind over lines of equal energy.

    All maps have the same initial values, and share their axes and one legend.
    """
    columns = min(len(maps), _IN_A_ROW)
    figure, panels = make_panels(
        len(maps), in_a_row=columns, height=_ORBIT_HEIGHT, legend_height=_ORBIT_LEGEND
    )
    for axes, orbit_map in zip(panels.flat, maps, strict=False):
        _draw_orbits(axes, orbit_map, columns)
    name_states(panels, [orbit_map.scheme_title for orbit_map in maps], maps[0].axes, _MARGIN)
    name_marks(figure, panels, 4)
    return figure


def _draw_orbits(axes: Any, orbit_map: OrbitMapResult, columns: int) -> None:
    xs, ys = (
        [float(Fraction(x)) for x in values] for values in (orbit_map.across, orbit_map.upwards)
    )
    width = (NARROW if columns == 1 else WIDE / columns) - 60
    # The area of a mark in points², so small that neighbouring marks do not overlap.
    area = min(30.0, (width / len(xs)) ** 2, ((_ORBIT_HEIGHT - 50) / len(ys)) ** 2) / 2
    for kind, mark in _ORBIT_MARKS.items():
        points = [(xs[j], ys[i]) for i, j in orbit_map.places() if orbit_map.kinds[i][j] == kind]
        if points:
            axes.scatter(*zip(*points, strict=True), s=area, label=kind, linewidths=0.6, **mark)
    energies = np.array(
        [[np.nan if e is None else float(e) for e in row] for row in orbit_map.energies]
    )
    # Contours need two rows and two columns of finite energies that differ.
    if min(energies.shape) > 1 and np.isfinite(energies).all() and np.ptp(energies) > 0:
        look = {"colors": INK, "linewidths": 0.5, "alpha": 0.35, "linestyles": "solid"}
        axes.contour(xs, ys, energies, levels=_CONTOUR_COUNT, **look)
