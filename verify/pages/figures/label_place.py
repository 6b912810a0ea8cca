"""Where a label stands beside what it names: clear of other labels and of all that is drawn."""

from collections.abc import Iterator, Sequence

import numpy as np

_APART = 3  # points between a label and what it names
_LINES = (0.0, 1.0, 2.0)  # how far it may be shifted away, in heights
_ALONG = (0.5, 0.2, 0.8)  # where along the image's width its middle may be

Box = tuple[float, float, float, float]
"""Left, lower, right and upper end, in points."""


def place_of(
    size: tuple[float, float], named: np.ndarray, drawn: np.ndarray, taken: list[Box], room: Box
) -> Box:
    """The label's box; `named` and `drawn` are points (n, 2), and it is no part of `taken` yet.

    The first of the places above, below and beside the image on which least is drawn. One that
    would leave the room or lie on another label is taken only where there is no other.
    """

    def cost(box: Box) -> tuple[bool, int]:
        bad = any(_overlap(box, other) for other in taken) or not _inside(box, room)
        return bad, _count(drawn, box)

    return min(_places(size, named, room), key=cost)


def dots(curves: Sequence[np.ndarray], low: np.ndarray, scale: float) -> np.ndarray:
    """Points close together on closed curves (n, 2), in points from the panel's corner `low`."""
    parts = []
    for curve in curves:
        ends = np.vstack([curve, curve[:1]])
        lengths = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(ends, axis=0).T))])
        at = np.linspace(0, lengths[-1], 2 + int(lengths[-1] * scale / 2))
        parts.append(np.column_stack([np.interp(at, lengths, ends[:, i]) for i in (0, 1)]))
    found: np.ndarray = (np.concatenate(parts) - low) * scale
    return found


def _places(size: tuple[float, float], named: np.ndarray, room: Box) -> Iterator[Box]:
    """Towards the nearer edge of the room first."""
    width, height = size
    (left, lower), (right, upper) = named.min(axis=0), named.max(axis=0)
    over = upper + _APART
    under = lower - _APART - height
    above = (lower + upper) / 2 >= (room[1] + room[3]) / 2
    for line in _LINES:
        rows = over + line * height, under - line * height
        for y in rows if above else rows[::-1]:
            for part in _ALONG:
                yield _box(left + part * (right - left) - width / 2, y, size)
        for y in ((lower + upper - height) / 2 + k * (upper - lower) / 4 for k in (0, 1, -1)):
            yield _box(right + _APART + line * height, y, size)
            yield _box(left - _APART - width - line * height, y, size)


def _box(x: float, y: float, size: tuple[float, float]) -> Box:
    return float(x), float(y), float(x + size[0]), float(y + size[1])


def _overlap(one: Box, other: Box) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def _inside(box: Box, room: Box) -> bool:
    return room[0] <= box[0] and room[1] <= box[1] and box[2] <= room[2] and box[3] <= room[3]


def _count(points: np.ndarray, box: Box) -> int:
    x, y = points.T
    return int(np.sum((x > box[0]) & (x < box[2]) & (y > box[1]) & (y < box[3])))
