"""Orbits as points, once in each period or where they pass a surface, a panel a map, as SVG."""

from collections.abc import Sequence
from math import remainder, tau
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from verify.pages.figures.panels import name_states, panels_beside
from verify.pages.figures.svg import INK, SERIES
from verify.scenes.results.orbit_sections import (
    MapSections,
    PoincareResult,
    SchemeSections,
    StroboscopicResult,
)

_HEIGHT, _IN_A_ROW = 330, 3
_MOST_DRAWN = 6000  # points of a figure
_FAINT, _ROOM = 0.35, 0.05
_FEW = 0.02  # of the points on either side, which may lie far out: of orbits that escape
_WIDER = 0.5  # of the extent of the others, on either side
Orbit = tuple[np.ndarray, int]
"""Its points (n, 2), and how many of the first are known."""


def drawn_looks(sections: Sequence[MapSections] | Sequence[SchemeSections], starts: int = 0) -> int:
    """How many of the first looks at an orbit are drawn, of all orbits alike.

    `starts`: so many of an orbit's points are where it starts, and no looks.
    """
    orbits = sum(len(each.orbits) for each in sections)
    points = (len(orbit.points) for each in sections for orbit in each.orbits)
    return min(max(points, default=starts) - starts, max(1, _MOST_DRAWN // max(1, orbits)))


def _first(points: Sequence[tuple[str, str]], count: int) -> np.ndarray:
    return np.array(points[:count], dtype=np.float64).reshape(-1, 2)


def drawn(result: PoincareResult) -> tuple[list[list[np.ndarray]], int]:
    """Of each map each orbit's first points (n, 2), and how many of all lie too far out to be
    drawn, as those of orbits that escape do: they have nan in their place.
    """
    shown = drawn_looks(result.sections)
    points = [[_first(o.points, shown) for o in each.orbits] for each in result.sections]
    every = np.concatenate([x for each in points for x in each])
    if not len(every):
        return points, 0
    low, high = np.quantile(every, (_FEW, 1 - _FEW), axis=0)
    room = _WIDER * (high - low)
    outside = 0
    for orbit in (x for each in points for x in each):
        far = ((orbit < low - room) | (orbit > high + room)).any(axis=1)
        outside += int(far.sum())
        orbit[far] = np.nan
    return points, outside


def draw_passes(result: PoincareResult) -> Figure:
    """Each orbit in a colour, grey where it is not known; the same axes for all maps."""
    panels = {
        each.map: [(x, orbit.known) for x, orbit in zip(points, each.orbits, strict=True)]
        for each, points in zip(result.sections, drawn(result)[0], strict=True)
    }
    return _draw(panels, result.draw, in_a_row=_IN_A_ROW, size=3.0)


def draw_periods(result: StroboscopicResult) -> Figure:
    """Each orbit in a colour; what more digits do not confirm is grey. An angle is in (−π, π]."""
    count = drawn_looks(result.sections, 1) + 1
    panels = {}
    for each in result.sections:
        orbits = [(_first(o.points, count), o.known + 1) for o in each.orbits]
        for points, _ in orbits if result.q_is_angle else ():
            points[:, 0] = [remainder(q, tau) for q in points[:, 0]]
        panels[each.scheme] = orbits
    return _draw(panels, ("q", "p"), in_a_row=len(panels), size=2.2)


def _draw(
    maps: dict[str, list[Orbit]], names: tuple[str, str], *, in_a_row: int, size: float
) -> Figure:
    figure, panels = panels_beside(len(maps), in_a_row=in_a_row, height=_HEIGHT)
    for axes, orbits in zip(panels.flat, maps.values(), strict=False):
        for index, (points, known) in enumerate(orbits):
            style: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": size}
            axes.plot(*points[known:].T, color=INK, alpha=_FAINT, **style)
            axes.plot(*points[:known].T, color=SERIES[index % len(SERIES)], **style)
    name_states(panels, list(maps), names, _ROOM)
    return figure
