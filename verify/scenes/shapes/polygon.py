"""Whether a polygon crosses or touches itself, in exact arithmetic."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

Value = int | Fraction
Pair = tuple[Value, Value]


def meetings(corners: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """The sides i < j that have a point in common, neighbours apart; side k begins at corner k."""
    count = len(corners)
    for i, j in _meeting_boxes(corners):
        if j - i not in (1, count - 1):
            ends = corners[i], corners[(i + 1) % count], corners[j], corners[(j + 1) % count]
            if _meet(*ends):
                yield i, j


def turns_back(before: Pair, here: Pair, after: Pair) -> bool:
    """Whether two neighbouring sides lie on each other."""
    (a, b), (x, y), (c, d) = before, here, after
    return _cross(before, here, after) == 0 and (x - a) * (c - x) + (y - b) * (d - y) < 0


def on_a_line(points: Sequence[Pair]) -> bool:
    other = next((point for point in points if point != points[0]), points[0])
    return all(_cross(points[0], other, point) == 0 for point in points)


def twice_the_area(corners: Sequence[Pair]) -> Value:
    """Positive where the corners go round counterclockwise."""
    return sum(_cross(corners[0], a, b) for a, b in pairwise(corners[1:]))


def _meeting_boxes(corners: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """The pairs of sides whose boxes meet, the smaller index first."""
    boxes = []
    for k, (one, other) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(one, other, strict=True))
        boxes.append((x0, x1, y0, y1, k))
    passed: list[tuple[int, int, int, int, int]] = []  # those that reach as far to the right
    for box in sorted(boxes):
        passed = [earlier for earlier in passed if earlier[1] >= box[0]]
        for _, _, low, high, k in passed:
            if low <= box[3] and box[2] <= high:
                yield min(box[4], k), max(box[4], k)
        passed.append(box)


def _meet(a: Pair, b: Pair, c: Pair, d: Pair) -> bool:
    """Whether the sides ab and cd, whose boxes meet, have a point in common."""
    # On one line all four are 0, and the boxes have decided.
    if _sign(_cross(a, b, c)) * _sign(_cross(a, b, d)) > 0:
        return False
    return _sign(_cross(c, d, a)) * _sign(_cross(c, d, b)) <= 0


def _cross(a: Pair, b: Pair, c: Pair) -> Value:
    """Twice the area of a triangle, negative where it goes round clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _sign(x: Value) -> int:
    return (x > 0) - (x < 0)
