"""A user's own shape: a polygon, checked exactly not to cross or touch itself, or SVG path data."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import lcm

from verify.arithmetic.exact import Number, rational, text
from verify.errors import InputError
from verify.scenes.shapes.outline import (
    Arc,
    EllipticalArc,
    Outline,
    Point,
    Shape,
    bezier,
    elliptical_curve,
)
from verify.scenes.shapes.svg_path import Segment, subpaths

Value = int | Fraction
Pair = tuple[Value, Value]


def find_meeting_sides(corners: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Yield the sides i < j, not neighbours, with a common point; side k begins at corner k."""
    count = len(corners)
    for i, j in _meeting_boxes(corners):
        # Neighbours always meet at their corner; `turns_back` checks these.
        if j - i not in (1, count - 1):
            ends = corners[i], corners[(i + 1) % count], corners[j], corners[(j + 1) % count]
            if _do_meet(*ends):
                yield i, j


def turns_back(before: Pair, corner: Pair, after: Pair) -> bool:
    """Return True if two neighbouring sides lie on each other."""
    (a, b), (x, y), (c, d) = before, corner, after
    return _cross(before, corner, after) == 0 and (x - a) * (c - x) + (y - b) * (d - y) < 0


def are_collinear(points: Sequence[Pair]) -> bool:
    second = next((point for point in points if point != points[0]), points[0])
    return all(_cross(points[0], second, point) == 0 for point in points)


def twice_the_area(corners: Sequence[Pair]) -> Value:
    """Return twice the area, positive where the corners go round counterclockwise."""
    return sum(_cross(corners[0], a, b) for a, b in pairwise(corners[1:]))


def _meeting_boxes(corners: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of sides whose boxes meet, the smaller index first."""
    boxes = []
    for k, (start, end) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(start, end, strict=True))
        boxes.append((x0, x1, y0, y1, k))
    # A sweep from left to right; the open boxes reach as far to the right as the current one.
    open_boxes: list[tuple[int, int, int, int, int]] = []
    for box in sorted(boxes):
        open_boxes = [earlier for earlier in open_boxes if earlier[1] >= box[0]]
        for _, _, low, high, k in open_boxes:
            if low <= box[3] and box[2] <= high:
                yield min(box[4], k), max(box[4], k)
        open_boxes.append(box)


def _do_meet(a: Pair, b: Pair, c: Pair, d: Pair) -> bool:
    """Return True if the sides ab and cd, whose boxes meet, have a point in common."""
    # On one line all four are 0, and the boxes have decided.
    if _sign(_cross(a, b, c)) * _sign(_cross(a, b, d)) > 0:
        return False
    return _sign(_cross(c, d, a)) * _sign(_cross(c, d, b)) <= 0


def _cross(a: Pair, b: Pair, c: Pair) -> Value:
    """Return twice the area of a triangle, negative where it goes round clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _sign(x: Value) -> int:
    return (x > 0) - (x < 0)


MAX_POINTS = 2_000
# Bits of a coordinate, so that float64 can hold its numerator and its denominator.
MAX_BITS = 400
MAX_COMMON_BITS = 2_000


def polygon(points: Sequence[Sequence[Number]], name: str = "polygon") -> Shape:
    """Return the polygon through the points [q, p], which may go round either way.

    Raises InputError, which names the point, unless there are 3 to 2,000 of them, not all on one
    line, none equal to the one before, and no two sides meet except neighbours at their corner.
    """
    if not isinstance(points, Sequence) or isinstance(points, str):
        raise InputError(name, points, "not a list of points [q, p]")
    if not 3 <= len(points) <= MAX_POINTS:
        raise InputError(name, len(points), f"points; allowed: 3 … {MAX_POINTS}")
    corners = [_read_point(point, f"{name} point {k}") for k, point in enumerate(points, 1)]
    _check_polygon(corners, name)
    if twice_the_area(corners) < 0:
        corners.reverse()
    sides = zip(corners, [*corners[1:], corners[0]], strict=True)
    return Shape(name, (Outline(name, tuple(bezier(*side) for side in sides)),))


def svg_path(data: str, name: str = "path") -> Shape:
    """Return the closed curves of SVG path data, each subpath an outline; q is x, p is −y.

    They keep their direction, clockwise or not, and are not checked for crossings.
    Raises InputError as `verify.scenes.shapes.svg_path.subpaths` does, and for a subpath that
    bounds no area.
    """
    if not isinstance(data, str):
        raise InputError(name, data, "not a text of path data")
    outlines = []
    for k, segments in enumerate(subpaths(data, name), 1):
        if _is_flat(segments):
            raise InputError(name, data, f"its subpath {k} lies on a line and bounds no area")
        outlines.append(Outline(f"{name} {k}", tuple(_arc_of(segment) for segment in segments)))
    return Shape(name, tuple(outlines))


def _arc_of(segment: Segment) -> Arc:
    return elliptical_curve(segment) if isinstance(segment, EllipticalArc) else bezier(*segment)


def _is_flat(segments: Sequence[Segment]) -> bool:
    points: list[Point] = []
    for segment in segments:
        if isinstance(segment, EllipticalArc):
            return False
        points.extend(segment)
    return are_collinear(points)


def _read_point(point: Sequence[Number], name: str) -> Point:
    if not isinstance(point, Sequence) or isinstance(point, str) or len(point) != 2:
        raise InputError(name, point, "not a pair [q, p]")
    q, p = rational(point[0], name), rational(point[1], name)
    for value in (q, p):
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > MAX_BITS:
            raise InputError(name, value, f"has more than {MAX_BITS} bits")
    return q, p


def _check_polygon(corners: Sequence[Point], name: str) -> None:
    count = len(corners)
    for k in range(count):
        if corners[k] == corners[k - 1]:
            raise _point_error(name, corners, k, f"is the same as point {k or count}")
    integers = _scale_to_integers(corners, name)
    if are_collinear(integers):
        raise InputError(name, f"{count} points", "all on one line")
    for k in range(count):
        if turns_back(integers[k - 1], integers[k], integers[(k + 1) % count]):
            raise _point_error(name, corners, k, "the polygon goes back there on its own side")
    for i, j in find_meeting_sides(integers):
        to = (j + 1) % count + 1
        raise _point_error(
            name, corners, i, f"the side from it meets the one from point {j + 1} to {to}"
        )


def _scale_to_integers(corners: Sequence[Point], name: str) -> list[tuple[int, int]]:
    """Return the points times their common denominator, since integers are compared fast."""
    common = lcm(*(value.denominator for corner in corners for value in corner))
    if common.bit_length() > MAX_COMMON_BITS:
        problem = f"the common denominator has more than {MAX_COMMON_BITS} bits"
        raise InputError(name, f"{len(corners)} points", problem)
    return [(int(x * common), int(y * common)) for x, y in corners]


def _point_error(name: str, corners: Sequence[Point], k: int, problem: str) -> InputError:
    return InputError(f"{name} point {k + 1}", ", ".join(map(text, corners[k])), problem)
