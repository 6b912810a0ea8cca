"""Places for labels beside images, clear of other labels and of all that is drawn."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.transforms import Bbox

# Points between a label and its image.
_LABEL_GAP = 3
# The distances, in heights of the label, by which it may be shifted away.
_SHIFTS = (0.0, 1.0, 2.0)
# The positions of the label's middle, as parts of the image's width.
_SHARES = (0.5, 0.2, 0.8)


def choose_place(
    size: tuple[float, float],
    target: np.ndarray,
    obstacles: np.ndarray,
    occupied: list[Bbox],
    room: Bbox,
) -> Bbox:
    """Return the box of a label of this size, without adding it to `occupied`.

    `target`: the points (n, 2) of the image; `obstacles`: those of everything that is drawn. Of the
    places above, below and beside the image, the first with the fewest obstacles is taken. A box
    that leaves the room or overlaps another label is taken only if there is no other.
    """

    def cost(box: Bbox) -> tuple[bool, int]:
        # False sorts before True, so that free places in the room come first.
        is_bad = any(map(box.fully_overlaps, occupied)) or not lies_in(box, room)
        return is_bad, box.count_contains(obstacles)

    return min(_places(size, target, room), key=cost)


def sample_curves(curves: Sequence[np.ndarray], low: np.ndarray, scale: float) -> np.ndarray:
    """Return close samples of closed curves (n, 2), in points from the panel's corner `low`."""
    # The samples are at most two points of the picture apart, so that no label fits between them.
    parts = []
    for curve in curves:
        closed = np.vstack([curve, curve[:1]])
        lengths = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
        arc_lengths = np.linspace(0, lengths[-1], 2 + int(lengths[-1] * scale / 2))
        parts.append(
            np.column_stack([np.interp(arc_lengths, lengths, closed[:, i]) for i in (0, 1)])
        )
    points: np.ndarray = (np.concatenate(parts) - low) * scale
    return points


def _places(size: tuple[float, float], target: np.ndarray, room: Bbox) -> Iterator[Bbox]:
    """Yield the boxes to try; above comes first for an image in the upper half, else below."""
    width, height = size
    (left, lower), (right, upper) = target.min(axis=0), target.max(axis=0)
    upper_row = upper + _LABEL_GAP
    lower_row = lower - _LABEL_GAP - height
    is_in_upper_half = (lower + upper) / 2 >= (room.y0 + room.y1) / 2
    for shift in _SHIFTS:
        rows = upper_row + shift * height, lower_row - shift * height
        for y in rows if is_in_upper_half else rows[::-1]:
            for share in _SHARES:
                yield Bbox.from_bounds(left + share * (right - left) - width / 2, y, *size)
        for y in ((lower + upper - height) / 2 + k * (upper - lower) / 4 for k in (0, 1, -1)):
            yield Bbox.from_bounds(right + _LABEL_GAP + shift * height, y, *size)
            yield Bbox.from_bounds(left - _LABEL_GAP - width - shift * height, y, *size)


def lies_in(box: Bbox, room: Bbox) -> bool:
    """Return True if the box lies in the room, or at its edge."""
    fits_across = room.x0 <= box.x0 and box.x1 <= room.x1
    return bool(fits_across and room.y0 <= box.y0 and box.y1 <= room.y1)
