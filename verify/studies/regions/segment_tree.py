"""A tree of boxes that finds the segment of a set of closed polylines nearest to a point.

A node's box holds segments that follow each other along the curves, so that boxes are small where
curves are smooth, however often they wind. Plain loops over float64 arrays, which LLVM compiles
(`verify.arithmetic.compiled.loops`).

scipy's cKDTree finds the nearest vertex, which may be far away where the segment is near: from
(5, −0.1) the boundary of 0 ≤ x ≤ 10, 0 ≤ y ≤ 1 is at 0.1 and its nearest vertex at 5. It also
cannot be called from the compiled loop that divides segments and asks for a few points at a time.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

LEAF = 8  # segments
_DEEP = 64  # a stack that no tree of fewer than 2^60 segments fills


def segments(curves: Sequence[np.ndarray[Any, np.dtype[np.float64]]]) -> Any:
    """Return rows x₀, y₀, x₁, y₁ of the closed polylines through each curve's points (x, y)."""
    rows = [np.hstack((curve, np.roll(curve, -1, axis=0))) for curve in curves]
    return np.ascontiguousarray(np.concatenate(rows))


def boxes(rows: Any) -> Any:
    """Build the tree: node k has the box x_min, y_min, x_max, y_max and the children 2k, 2k + 1."""
    leaves = 1
    while leaves * LEAF < len(rows):
        leaves *= 2
    # Copies of the last segment fill the last leaves: they change no box and no nearest distance.
    padded = np.concatenate((rows, np.repeat(rows[-1:], leaves * LEAF - len(rows), axis=0)))
    corners = padded.reshape(leaves, 2 * LEAF, 2)
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
            first = (node - leaves) * LEAF
            for k in range(first, min(first + LEAF, len(rows))):
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
    return np.empty(2 * _DEEP, dtype=np.int64)
