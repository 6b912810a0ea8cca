"""The Hausdorff distance of two sets of closed curves, each given by points close together on it.

It is the greatest distance of a point of either set from the other set. The maximum over the points
of a polyline's segments is enclosed, not only that over its vertices: along a part of a segment the
distance from one segment of the other set is convex, so that it is bounded by its values at the
ends of the part; where that bound is too wide, the part is divided. (Branch and bound, as in
M. Tang, M. Lee, Y. J. Kim, Interactive Hausdorff distance computation for general polygonal models,
ACM Trans. Graph. 28 (2009).)

A tree of boxes finds the segment nearest to a point. A node's box holds segments that follow each
other along the curves, so that boxes are small where curves are smooth, however often they wind.
scipy's cKDTree finds the nearest vertex, which may be far away where the segment is near: from
(5, −0.1) the boundary of 0 ≤ x ≤ 10, 0 ≤ y ≤ 1 is at 0.1 and its nearest vertex at 5. It also
cannot be called from the loop that divides segments and asks for a few points at a time: LLVM
compiles plain loops over float64 arrays (`verify.arithmetic.compiled.loops`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import isfinite, sqrt
from typing import Any

import numpy as np

from verify.errors import InputError

LEAF_SIZE = 8  # segments
_STACK_DEPTH = 64  # no tree of fewer than 2^60 segments fills such a stack


def segments(curves: Sequence[np.ndarray[Any, np.dtype[np.float64]]]) -> Any:
    """Return rows x₀, y₀, x₁, y₁ of the closed polylines through each curve's points (x, y)."""
    rows = [np.hstack((curve, np.roll(curve, -1, axis=0))) for curve in curves]
    return np.ascontiguousarray(np.concatenate(rows))


def boxes(rows: Any) -> Any:
    """Build the tree: node k has the box x_min, y_min, x_max, y_max and the children 2k, 2k + 1."""
    leaves = 1
    while leaves * LEAF_SIZE < len(rows):
        leaves *= 2
    # Copies of the last segment fill the last leaves: they change no box and no nearest distance.
    padded = np.concatenate((rows, np.repeat(rows[-1:], leaves * LEAF_SIZE - len(rows), axis=0)))
    corners = padded.reshape(leaves, 2 * LEAF_SIZE, 2)
    tree = np.empty((2 * leaves, 4))
    tree[leaves:] = np.hstack((corners.min(axis=1), corners.max(axis=1)))
    while leaves > 1:
        children = tree[leaves : 2 * leaves]
        leaves //= 2
        tree[leaves : 2 * leaves, :2] = np.minimum(children[::2, :2], children[1::2, :2])
        tree[leaves : 2 * leaves, 2:] = np.maximum(children[::2, 2:], children[1::2, 2:])
    return tree


def to_segment(x: float, y: float, row: Any) -> Any:
    """Return the squared distance of a point from a segment."""
    along_x, along_y = row[2] - row[0], row[3] - row[1]
    from_x, from_y = x - row[0], y - row[1]
    length = along_x * along_x + along_y * along_y
    if length > 0.0:
        part = (from_x * along_x + from_y * along_y) / length
        if part >= 1.0:  # from the end itself: no rounding of it
            from_x, from_y = x - row[2], y - row[3]
        elif part > 0.0:
            # By the cross product: the small residual of a long difference would be all rounding.
            cross = from_x * along_y - from_y * along_x
            return cross * cross / length
    return from_x * from_x + from_y * from_y


def _to_box(x: float, y: float, box: Any) -> Any:
    """Return the squared distance of a point from a box, 0 within."""
    out_x = max(box[0] - x, 0.0, x - box[2])
    out_y = max(box[1] - y, 0.0, y - box[3])
    return out_x * out_x + out_y * out_y


def nearest(x: float, y: float, rows: Any, tree: Any, hint: int, stack: Any) -> tuple[float, int]:
    """Return the squared distance of the nearest segment and its index, trying `hint` first."""
    index, best = hint, to_segment(x, y, rows[hint])
    leaves, count = len(tree) // 2, 1
    stack[0] = 1
    while count > 0:
        count -= 1
        node = stack[count]
        if _to_box(x, y, tree[node]) >= best:
            continue
        if node >= leaves:
            first = (node - leaves) * LEAF_SIZE
            for k in range(first, min(first + LEAF_SIZE, len(rows))):
                square = to_segment(x, y, rows[k])
                if square < best:
                    index, best = k, square
            continue
        near = 2 * node
        if _to_box(x, y, tree[near + 1]) < _to_box(x, y, tree[near]):
            near += 1
        # The nearer child is searched first, so that the other can mostly be skipped.
        stack[count], stack[count + 1] = near ^ 1, near
        count += 2
    return best, index


def new_stack() -> Any:
    """Return work space for `nearest`: an array of node numbers, deep enough for any tree."""
    return np.empty(2 * _STACK_DEPTH, dtype=np.int64)


Curve = np.ndarray[Any, np.dtype[np.float64]]
RELATIVE = 1e-6  # the relative width of the enclosure of the polylines' distance
# Relative to the greatest coordinate: the rounding of this module, not that of the points.
_ROUNDING = 2.0**-48
# The square of no coordinate overflows, and a square that matters is not lost.
FARTHEST, _LEAST = 1e150, 1e-150
_MAX_DIVISIONS = 60  # a segment's part this deep is divided no further
_HALVINGS = 40


@dataclass(frozen=True)
class Distance:
    """A distance: |`value` − the distance| ≤ `bound`."""

    value: float
    bound: float


def hausdorff(
    first: Sequence[Curve],
    second: Sequence[Curve],
    sagitta_first: float = 0.0,
    sagitta_second: float = 0.0,
) -> Distance:
    """Return the Hausdorff distance of the unions of two sets of closed curves.

    A curve is an array of shape (n, 2), its points in their order; the last is joined to the first.
    `sagitta_…` bounds the Hausdorff distance of each polyline from its curve, and is a part of the
    result's bound; 0 where the polyline itself is meant. Raises InputError if a set has no
    point, a coordinate is beyond ±1e150, or a sagitta is negative or not finite.
    """
    sets = [_segments("first", first), _segments("second", second)]
    for name, sagitta in (("sagitta_first", sagitta_first), ("sagitta_second", sagitta_second)):
        if not (isfinite(sagitta) and sagitta >= 0):
            raise InputError(name, sagitta, "must be finite and at least 0")
    # Relative to the greatest coordinate of both sets; `_LEAST` keeps it above 0 for points at the
    # origin.
    rounding = max(_LEAST, *(_ROUNDING * float(abs(rows).max()) for rows in sets))
    low, high = _enclose_distance(sets[0], sets[1], rounding)
    return Distance(low, high - low + sagitta_first + sagitta_second + rounding)


def _segments(name: str, curves: Sequence[Curve]) -> Any:
    for curve in curves:
        if curve.ndim != 2 or curve.shape[1] != 2 or not len(curve):
            raise InputError(name, curve.shape, "not an array of points, of shape (n, 2), n ≥ 1")
        if not (np.abs(curve) <= FARTHEST).all():
            raise InputError(name, "curves", f"a coordinate is not finite, or beyond ±{FARTHEST}")
    if not curves:
        raise InputError(name, "curves", "there is none")
    return segments([np.asarray(curve, dtype=np.float64) for curve in curves])


def _enclose_distance(first: Any, second: Any, rounding: float) -> tuple[float, float]:
    """Return bounds, from below and above, of the polylines' distance, up to `rounding`."""
    forth = _enclose_directed(first, second, 0.0, rounding)
    # The distance is the maximum of both directions: a point of the second set that is nearer than
    # the first direction's distance does not change it.
    back = _enclose_directed(second, first, forth[0], rounding)
    return back[0], max(forth[1], back[1])


def _enclose_directed(
    rows: Any, others: Any, at_least: float, rounding: float
) -> tuple[float, float]:
    near = np.empty((len(rows), 2), dtype=np.int64)
    parts = np.empty((_MAX_DIVISIONS + 2, 4))
    nears = np.empty((_MAX_DIVISIONS + 2, 3), dtype=np.int64)
    work = new_stack(), parts, nears
    low, high = _compile_loop()(rows, others, boxes(others), near, *work, at_least, rounding)
    return float(low), float(high)


@cache
def _compile_loop() -> Callable[..., tuple[float, float]]:
    from verify.arithmetic.compiled.loops import compile_function

    return compile_function(_directed_distance)


def _distance(x: float, y: float, row: Any) -> float:
    return sqrt(to_segment(x, y, row))


def _bound_on_part(part: Any, start: Any, end: Any, enough: float) -> tuple[float, float]:
    """Return a bound on the distance along a part of a segment, and where to divide it.

    `part` is x₀, y₀, x₁, y₁; `start` and `end` are the other set's segments nearest to its ends. Up
    to some point of the part the distance from `start` is the bound, and beyond it that from `end`.
    Bisection looks for the point until the bound is at most `enough`. The part is to be divided
    there, at a share of its length between 0.05 and 0.95.
    """
    x, y, along_x, along_y = part[0], part[1], part[2] - part[0], part[3] - part[1]
    low, high = 0.0, 1.0
    ends = max(_distance(x, y, start), _distance(part[2], part[3], end))
    bound = max(ends, min(_distance(part[2], part[3], start), _distance(x, y, end)))
    for _ in range(_HALVINGS):  # towards the point at which both distances are equal
        if bound <= enough:
            break
        middle = (low + high) / 2
        at_x, at_y = x + middle * along_x, y + middle * along_y
        before, after = _distance(at_x, at_y, start), _distance(at_x, at_y, end)
        bound = min(bound, max(ends, before, after))
        if before <= after:
            low = middle
        else:
            high = middle
    return bound, min(max(low, 0.05), 0.95)


def _greatest_on_segment(
    row: Any,
    near: Any,
    others: Any,
    tree: Any,
    stack: Any,
    parts: Any,
    nears: Any,
    low: float,
    rounding: float,
) -> tuple[float, float]:
    """Return bounds, from below and above, of the greatest distance from `others`.

    The first is the greater of `low` and the distances at points of the segment `row`, the second
    is of this segment alone. `near` has the indices of the segments nearest to its ends.
    """
    high, count = 0.0, 1
    for k in range(4):
        parts[0, k] = row[k]
    nears[0, 0], nears[0, 1], nears[0, 2] = near[0], near[1], 0
    while count > 0:
        count -= 1
        x0, y0, x1, y1 = parts[count]
        start, end, depth = nears[count]
        enough = low * (1.0 + RELATIVE) + rounding
        ends = _distance(x0, y0, others[start]) + _distance(x1, y1, others[end])
        # Along the part the distance changes at most by the length that is gone.
        bound, share = (ends + sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))) / 2, 0.5
        if bound > enough:
            closer, share = _bound_on_part(parts[count], others[start], others[end], enough)
            bound = min(bound, closer)
        if bound <= enough or depth == _MAX_DIVISIONS:
            high = max(high, bound)
            continue
        x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
        square, middle = nearest(x, y, others, tree, start, stack)
        low = max(low, sqrt(square))
        nears[count, 0], nears[count, 1], nears[count, 2] = start, middle, depth + 1
        nears[count + 1, 0], nears[count + 1, 1], nears[count + 1, 2] = middle, end, depth + 1
        parts[count, 0], parts[count, 1], parts[count, 2], parts[count, 3] = x0, y0, x, y
        parts[count + 1, 0], parts[count + 1, 1] = x, y
        parts[count + 1, 2], parts[count + 1, 3] = x1, y1
        count += 2
    return low, high


def _directed_distance(
    rows: Any,
    others: Any,
    tree: Any,
    near: Any,
    stack: Any,
    parts: Any,
    nears: Any,
    at_least: float,
    rounding: float,
) -> tuple[float, float]:
    """Return bounds, from below and above, of the greatest distance of `rows` from `others`.

    Both are at least `at_least`. `near`, with one row for each segment, `stack`, `parts` and
    `nears` are work space.
    """
    low, hint = at_least, 0
    for k in range(len(rows)):
        square, hint = nearest(rows[k, 0], rows[k, 1], others, tree, hint, stack)
        low, near[k, 0] = max(low, sqrt(square)), hint
    high = low
    for k in range(len(rows)):
        follows = (k + 1) % len(rows)
        near[k, 1] = near[follows, 0]
        if rows[k, 2] != rows[follows, 0] or rows[k, 3] != rows[follows, 1]:
            _, near[k, 1] = nearest(rows[k, 2], rows[k, 3], others, tree, near[k, 0], stack)
        low, bound = _greatest_on_segment(
            rows[k], near[k], others, tree, stack, parts, nears, low, rounding
        )
        high = max(high, bound, low)
    return low, high
