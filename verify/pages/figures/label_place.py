"""Where a label stands beside what it names: clear of other labels and of all that is drawn."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.transforms import Bbox

_APART = 3  # points between a label and what it names
_LINES = (0.0, 1.0, 2.0)  # how far it may be shifted away, in heights
_ALONG = (0.5, 0.2, 0.8)  # where along the image's width its middle may be


def place_of(
    size: tuple[float, float], named: np.ndarray, drawn: np.ndarray, taken: list[Bbox], room: Bbox
) -> Bbox:
    """The label's box, which is no part of `taken` yet; `named` and `drawn` are points (n, 2).

    The first of the places above, below and beside the image on which least is drawn. One that
    would leave the room or lie on another label is taken only where there is no other.
    """

    def cost(box: Bbox) -> tuple[bool, int]:
        bad = any(map(box.fully_overlaps, taken)) or not within(box, room)
        return bad, box.count_contains(drawn)

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


def _places(size: tuple[float, float], named: np.ndarray, room: Bbox) -> Iterator[Bbox]:
    """Towards the nearer edge of the room first."""
    width, height = size
    (left, lower), (right, upper) = named.min(axis=0), named.max(axis=0)
    over = upper + _APART
    under = lower - _APART - height
    above = (lower + upper) / 2 >= (room.y0 + room.y1) / 2
    for line in _LINES:
        rows = over + line * height, under - line * height
        for y in rows if above else rows[::-1]:
            for part in _ALONG:
                yield Bbox.from_bounds(left + part * (right - left) - width / 2, y, *size)
        for y in ((lower + upper - height) / 2 + k * (upper - lower) / 4 for k in (0, 1, -1)):
            yield Bbox.from_bounds(right + _APART + line * height, y, *size)
            yield Bbox.from_bounds(left - _APART - width - line * height, y, *size)


def within(box: Bbox, room: Bbox) -> bool:
    """Whether the box lies in the room, or at its edge."""
    across = room.x0 <= box.x0 and box.x1 <= room.x1
    return bool(across and room.y0 <= box.y0 and box.y1 <= room.y1)
