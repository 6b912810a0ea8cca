"""Curves as polylines: dense ones to measure with, thinned ones to draw."""

from collections.abc import Sequence

import numpy as np

from verify.arithmetic.float_context import FLOAT
from verify.scenes.shapes.outline import Shape
from verify.studies.regions.panels import NODES, interpolation

_DRAWN = 800  # a curve is drawn to this part of the picture's size
_TRACED = 400  # points of an arc that is drawn as it is
_MOST_POINTS = 40_000  # of a dense curve
_BETWEEN = 16, 128  # points of a panel of 16 nodes, at least and at most
_TINY = float(np.finfo(np.float64).tiny)
_MORE = 1.5  # the arc between two points may be farther from its chord than its middle is


def dense(
    panels: Sequence[tuple[np.ndarray, ...]], points: int = _MOST_POINTS
) -> tuple[np.ndarray, float]:
    """A closed curve's points (n, 2), about so many, and how far it is from its chords at most.

    From the nodes of its panels. The distance is an estimate, by points midway between those.
    """
    least, most = _BETWEEN
    between = min(most, max(least, points // len(panels)))
    matrix = interpolation(2 * between)
    nodes = np.array([np.stack(z, axis=1) for z in panels], dtype=np.float64).reshape(-1, NODES, 2)
    fine = np.einsum("kn,pnd->pkd", matrix, nodes).reshape(-1, 2)
    found, middles = fine[::2], fine[1::2]
    apart = middles - (found + np.roll(found, -1, axis=0)) / 2
    return found, float(_MORE * np.hypot(*apart.T).max())


def thinned(points: np.ndarray, tolerance: float) -> np.ndarray:
    """The closed polyline with as few points as stay within the tolerance (Douglas–Peucker)."""
    closed = np.concatenate([points, points[:1]])
    at = closed[:, 0] + 1j * closed[:, 1]
    kept = np.zeros(len(closed), dtype=bool)
    far = int(abs(at - at[0]).argmax())
    kept[[0, far, -1]] = True
    todo = [(0, far), (far, len(closed) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        apart = _from_chord(at[first + 1 : last], at[first], at[last])
        worst = int(apart.argmax())
        if apart[worst] > tolerance:
            middle = first + 1 + worst
            kept[middle] = True
            todo += [(first, middle), (middle, last)]
    return closed[:-1][kept[:-1]]


def to_draw(curves: Sequence[np.ndarray]) -> list[np.ndarray]:
    """The curves of one picture, each thinned as far as the picture does not show it."""
    extent = float(np.ptp(np.concatenate(curves), axis=0).max())
    return [thinned(curve, extent / _DRAWN) for curve in curves]


def _from_chord(points: np.ndarray, start: complex, end: complex) -> np.ndarray:
    """Distances of points of the complex plane from a segment."""
    along, apart = end - start, points - start
    length = abs(along)
    if length < _TINY:  # a point, which nothing can be divided by
        return abs(apart)
    apart /= along
    apart -= np.minimum(np.maximum(apart.real, 0), 1)
    found: np.ndarray = abs(apart) * length
    return found


def text(points: np.ndarray) -> str:
    """`x,y x,y …` with five significant digits."""
    return " ".join(f"{x:.5g},{y:.5g}" for x, y in points)


def parsed(points: str) -> np.ndarray:
    """The array (n, 2) that `text` wrote."""
    pairs = [pair.split(",") for pair in points.split()]
    return np.array(pairs, dtype=np.float64).reshape(-1, 2)


def traced(shape: Shape) -> list[np.ndarray]:
    """The shape's own outlines, thinned for drawing."""
    s = np.arange(_TRACED) / _TRACED
    curves = []
    for outline in shape.outlines:
        arcs = (np.broadcast_arrays(*arc(FLOAT, s), s)[:2] for arc in outline.arcs)
        curves.append(np.concatenate([np.stack(arc, axis=1) for arc in arcs]))
    return to_draw(curves)
