"""Orbits as points, once in each period or on a surface, with a panel for each map."""

from collections.abc import Sequence
from math import remainder, tau
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from verify.pages.figures.axes import make_panels, name_states
from verify.pages.figures.sheet import INK, SERIES
from verify.scenes.results import orbit_points

_HEIGHT, _IN_A_ROW = 330, 3
# The limit on points in a figure, for the size of the file.
_MAX_POINTS = 6000
# The opacity of unconfirmed points, and the margin as a part of the axes.
_FAINT, _MARGIN = 0.35, 0.05
# The part of the points on either side that the extent leaves out, as they may belong to escaping
# orbits.
_TAIL_SHARE = 0.02
# Points outside the extent by more than this part of it are not drawn.
_OUTSIDE_SHARE = 0.5
Orbit = tuple[np.ndarray, int]
"""The orbit's points (n, 2), and the number of points, from the first on, that are confirmed."""


def count_drawn_looks(
    sections: Sequence[orbit_points.MapSections] | Sequence[orbit_points.SchemeSections],
    starts: int = 0,
) -> int:
    """Return the number of points of each orbit, from the first on, that are drawn.

    `starts`: the number of points, 0 or 1, that are initial states; they are not counted.
    """
    orbits = sum(len(section.orbits) for section in sections)
    points = (len(orbit.points) for section in sections for orbit in section.orbits)
    return min(max(points, default=starts) - starts, max(1, _MAX_POINTS // max(1, orbits)))


def _first(points: Sequence[tuple[str, str]], count: int) -> np.ndarray:
    return np.array(points[:count], dtype=np.float64).reshape(-1, 2)


def select_points(result: orbit_points.PoincareResult) -> tuple[list[list[np.ndarray]], int]:
    """Return each orbit's first points (n, 2) by map, and the number of points too far out.

    Points too far out, as those of escaping orbits, would shrink the others: they are replaced by
    nan.
    """
    count = count_drawn_looks(result.sections)
    points = [[_first(o.points, count) for o in section.orbits] for section in result.sections]
    all_points = np.concatenate([x for points_of_map in points for x in points_of_map])
    if not len(all_points):
        return points, 0
    low, high = np.quantile(all_points, (_TAIL_SHARE, 1 - _TAIL_SHARE), axis=0)
    margin = _OUTSIDE_SHARE * (high - low)
    outside_count = 0
    for orbit in (x for points_of_map in points for x in points_of_map):
        # The quantiles are robust against a few escaping orbits, unlike the extremes.
        is_outside = ((orbit < low - margin) | (orbit > high + margin)).any(axis=1)
        outside_count += int(is_outside.sum())
        orbit[is_outside] = np.nan
    return points, outside_count


def draw_passes(result: orbit_points.PoincareResult) -> Figure:
    """Draw each orbit in a colour, its unconfirmed part grey, with the same axes for all maps."""
    panels = {
        section.map: [(x, orbit.known) for x, orbit in zip(points, section.orbits, strict=True)]
        for section, points in zip(result.sections, select_points(result)[0], strict=True)
    }
    return _draw(panels, result.draw, in_a_row=_IN_A_ROW, size=3.0)


def draw_periods(result: orbit_points.StroboscopicResult) -> Figure:
    """Draw each orbit in a colour, its unconfirmed part grey; an angle is in (−π, π]."""
    count = count_drawn_looks(result.sections, 1) + 1
    panels = {}
    for section in result.sections:
        orbits = [(_first(o.points, count), o.known + 1) for o in section.orbits]
        for points, _ in orbits if result.q_is_angle else ():
            # The IEEE remainder lies in [−π, π], symmetric about 0 as the figure is.
            points[:, 0] = [remainder(q, tau) for q in points[:, 0]]
        panels[section.scheme] = orbits
    return _draw(panels, ("q", "p"), in_a_row=len(panels), size=2.2)


def _draw(
    maps: dict[str, list[Orbit]], names: tuple[str, str], *, in_a_row: int, size: float
) -> Figure:
    figure, panels = make_panels(len(maps), in_a_row=in_a_row, height=_HEIGHT)
    for axes, orbits in zip(panels.flat, maps.values(), strict=False):
        for index, (points, confirmed_count) in enumerate(orbits):
            style: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": size}
            axes.plot(*points[confirmed_count:].T, color=INK, alpha=_FAINT, **style)
            axes.plot(*points[:confirmed_count].T, color=SERIES[index % len(SERIES)], **style)
    name_states(panels, list(maps), names, _MARGIN)
    return figure
