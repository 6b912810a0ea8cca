"""The kinds of orbits over two of their initial values, with a panel for each scheme, as SVG."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from verify.pages.figures.notebook_figure import NARROW, WIDE
from verify.pages.figures.panels import make_panels, name_marks, name_states
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.stability import OrbitKind, OrbitMapResult

_IN_A_ROW, _HEIGHT, _LEGEND, _ROOM = 3, 250, 40, 0.04
# The number of lines of equal energy.
_LEVELS = 6

# The marks of the kinds; they differ in shape as well, so that no one depends on colours.
_MARKS: dict[OrbitKind, dict[str, Any]] = {
    "regular": {"marker": ".", "color": SERIES[0]},
    "sensitive": {"marker": "s", "color": SERIES[1]},
    "undecided": {"marker": "+", "color": SERIES[7]},
    "leaves": {"marker": "^", "color": SERIES[4], "facecolors": "none", "alpha": 0.5},
}


def draw_orbit_maps(maps: Sequence[OrbitMapResult]) -> Figure:
    """Draw each orbit by its kind's mark over lines of equal energy; the maps share the starts."""
    columns = min(len(maps), _IN_A_ROW)
    figure, panels = make_panels(len(maps), in_a_row=columns, height=_HEIGHT, legend_height=_LEGEND)
    for axes, orbit_map in zip(panels.flat, maps, strict=False):
        _panel(axes, orbit_map, columns)
    name_states(panels, [orbit_map.scheme for orbit_map in maps], maps[0].axes, _ROOM)
    name_marks(figure, panels, 4)
    return figure


def _panel(axes: Any, orbit_map: OrbitMapResult, columns: int) -> None:
    xs, ys = (
        [float(Fraction(x)) for x in values] for values in (orbit_map.across, orbit_map.upwards)
    )
    width = (NARROW if columns == 1 else WIDE / columns) - 60
    # The area of a mark in points², such that neighbouring marks do not overlap.
    size = min(30.0, (width / len(xs)) ** 2, ((_HEIGHT - 50) / len(ys)) ** 2) / 2
    for kind, mark in _MARKS.items():
        places = [(xs[j], ys[i]) for i, j in orbit_map.places() if orbit_map.kinds[i][j] == kind]
        if places:
            axes.scatter(*zip(*places, strict=True), s=size, label=kind, linewidths=0.6, **mark)
    energies = np.array(
        [[np.nan if e is None else float(e) for e in row] for row in orbit_map.energies]
    )
    # Contours need two rows and two columns of finite energies that differ.
    if min(energies.shape) > 1 and np.isfinite(energies).all() and np.ptp(energies) > 0:
        look = {"colors": INK, "linewidths": 0.5, "alpha": 0.35, "linestyles": "solid"}
        axes.contour(xs, ys, energies, levels=_LEVELS, **look)
