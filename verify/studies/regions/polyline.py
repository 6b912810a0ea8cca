"""Polylines to draw: outlines and curves thinned, and their points as text."""

from collections.abc import Sequence

import numpy as np

from verify.arithmetic.float_context import FLOAT
from verify.scenes.shapes.outline import Shape

_RESOLUTION = 800  # a curve is drawn to the picture's size divided by this
_POINTS_PER_ARC = 400
_TINY = float(np.finfo(np.float64).tiny)


def thin(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Thin a closed polyline to few points that stay within the tolerance (Douglas–Peucker)."""
    ring = np.concatenate([points, points[:1]])
    plane_points = ring[:, 0] + 1j * ring[:, 1]
    keep = np.zeros(len(ring), dtype=bool)
    # Two distant points of a closed curve start the division; a chord from a point to itself would
    # have no direction.
    farthest = int(abs(plane_points - plane_points[0]).argmax())
    keep[[0, farthest, -1]] = True
    todo = [(0, farthest), (farthest, len(ring) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        distances = _from_chord(
            plane_points[first + 1 : last], plane_points[first], plane_points[last]
        )
        worst = int(distances.argmax())
        if distances[worst] > tolerance:
            middle = first + 1 + worst
            keep[middle] = True
            todo += [(first, middle), (middle, last)]
    return ring[:-1][keep[:-1]]


def thin_for_drawing(curves: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Thin the curves of one picture, each to within the picture's resolution."""
    extent = float(np.ptp(np.concatenate(curves), axis=0).max())
    return [thin(curve, extent / _RESOLUTION) for curve in curves]


def _from_chord(points: np.ndarray, start: complex, end: complex) -> np.ndarray:
    """Return distances of points of the complex plane from a segment."""
    along, offsets = end - start, points - start
    length = abs(along)
    if length < _TINY:  # the segment is a point: no division by its length
        return abs(offsets)
    offsets /= along
    offsets -= np.minimum(np.maximum(offsets.real, 0), 1)
    distances: np.ndarray = abs(offsets) * length
    return distances


def format_points(points: np.ndarray) -> str:
    """Return `x,y x,y …` with five significant digits."""
    return " ".join(f"{x:.5g},{y:.5g}" for x, y in points)


def parse_points(points: str) -> np.ndarray:
    """Return the array (n, 2) that `format_points` wrote."""
    pairs = [pair.split(",") for pair in points.split()]
    return np.array(pairs, dtype=np.float64).reshape(-1, 2)


def trace_outlines(shape: Shape) -> list[np.ndarray]:
    """Return the shape's own outlines, thinned for drawing."""
    s = np.arange(_POINTS_PER_ARC) / _POINTS_PER_ARC
    curves = []
    for outline in shape.outlines:
        arcs = (np.broadcast_arrays(*arc(FLOAT, s), s)[:2] for arc in outline.arcs)
        curves.append(np.concatenate([np.stack(arc, axis=1) for arc in arcs]))
    return thin_for_drawing(curves)
