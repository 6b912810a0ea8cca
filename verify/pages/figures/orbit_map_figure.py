"""What orbits do over two of their initial values, a panel a scheme, as SVG."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from verify.pages.figures.notebook_figure import NARROW, WIDE
from verify.pages.figures.panels import name_marks, name_states, panels_beside
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.stability import OrbitKind, OrbitMapResult

_IN_A_ROW, _HEIGHT, _LEGEND, _ROOM = 3, 250, 40, 0.04
_LEVELS = 6  # lines of equal energy

# What a kind looks like; shapes differ as well as colours.
_MARKS: dict[OrbitKind, dict[str, Any]] = {
    "regular": {"marker": ".", "color": SERIES[0]},
    "sensitive": {"marker": "s", "color": SERIES[1]},
    "undecided": {"marker": "+", "color": SERIES[7]},
    "leaves": {"marker": "^", "color": SERIES[4], "facecolors": "none", "alpha": 0.5},
}


def draw_orbit_maps(maps: Sequence[OrbitMapResult]) -> Figure:
    """Each orbit by its kind's mark, over lines of equal energy; all maps over the same starts."""
    columns = min(len(maps), _IN_A_ROW)
    figure, panels = panels_beside(len(maps), in_a_row=columns, height=_HEIGHT, beside=_LEGEND)
    for axes, over in zip(panels.flat, maps, strict=False):
        _panel(axes, over, columns)
    name_states(panels, [over.scheme for over in maps], maps[0].axes, _ROOM)
    name_marks(figure, panels, 4)
    return figure


def _panel(axes: Any, over: OrbitMapResult, columns: int) -> None:
    xs, ys = ([float(Fraction(x)) for x in values] for values in (over.across, over.upwards))
    width = (NARROW if columns == 1 else WIDE / columns) - 60
    size = min(30.0, (width / len(xs)) ** 2, ((_HEIGHT - 50) / len(ys)) ** 2) / 2
    for kind, mark in _MARKS.items():
        places = [(xs[j], ys[i]) for i, j in over.places() if over.kinds[i][j] == kind]
        if places:
            axes.scatter(*zip(*places, strict=True), s=size, label=kind, linewidths=0.6, **mark)
    energies = np.array([[np.nan if e is None else float(e) for e in row] for row in over.energies])
    if min(energies.shape) > 1 and np.isfinite(energies).all() and np.ptp(energies) > 0:
        look = {"colors": INK, "linewidths": 0.5, "alpha": 0.35, "linestyles": "solid"}
        axes.contour(xs, ys, energies, levels=_LEVELS, **look)
