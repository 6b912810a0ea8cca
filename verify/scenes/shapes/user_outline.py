"""A user's own shape: a polygon, or SVG's path data."""

from collections.abc import Sequence
from math import lcm

from verify.arithmetic.exact import Exact, rational, text
from verify.errors import InputError
from verify.scenes.shapes.elliptical_arc import EllipticalArc, elliptical
from verify.scenes.shapes.outline import Arc, Outline, Point, Shape, bezier
from verify.scenes.shapes.polygon import meetings, on_a_line, turns_back, twice_the_area
from verify.scenes.shapes.svg_path import Segment, subpaths

MAX_POINTS = 2_000
MAX_BITS = 400  # of a coordinate: float64 then holds its numerator and its denominator
MAX_COMMON_BITS = 2_000


def polygon(points: Sequence[Sequence[Exact]], name: str = "polygon") -> Shape:
    """The polygon through the points [q, p], which may go round either way; its corners are kept.

    Raises InputError, which names the point, unless there are 3 to 2,000 of them, not all on one
    line, none equal to the one before, and no two sides meet but neighbours at their corner.
    """
    if not isinstance(points, Sequence) or isinstance(points, str):
        raise InputError(name, points, "not a list of points [q, p]")
    if not 3 <= len(points) <= MAX_POINTS:
        raise InputError(name, len(points), f"points; allowed: 3 … {MAX_POINTS}")
    corners = [_point(point, f"{name} point {k}") for k, point in enumerate(points, 1)]
    _check(corners, name)
    if twice_the_area(corners) < 0:
        corners.reverse()
    sides = zip(corners, [*corners[1:], corners[0]], strict=True)
    return Shape(name, (Outline(name, tuple(bezier(*side) for side in sides)),))


def svg_path(data: str, name: str = "path") -> Shape:
    """The closed curves of SVG's path data, each subpath an outline; q is x, p is −y.

    They run as they are drawn, clockwise or not, and are not asked whether they cross themselves.
    Raises InputError as `verify.scenes.shapes.svg_path.subpaths` does, and for a subpath that
    bounds no area.
    """
    if not isinstance(data, str):
        raise InputError(name, data, "not a text of path data")
    outlines = []
    for k, segments in enumerate(subpaths(data, name), 1):
        if _flat(segments):
            raise InputError(name, data, f"its subpath {k} lies on a line and bounds no area")
        outlines.append(Outline(f"{name} {k}", tuple(_arc(segment) for segment in segments)))
    return Shape(name, tuple(outlines))


def _arc(segment: Segment) -> Arc:
    return elliptical(segment) if isinstance(segment, EllipticalArc) else bezier(*segment)


def _flat(segments: Sequence[Segment]) -> bool:
    points: list[Point] = []
    for segment in segments:
        if isinstance(segment, EllipticalArc):
            return False
        points.extend(segment)
    return on_a_line(points)


def _point(point: Sequence[Exact], name: str) -> Point:
    if not isinstance(point, Sequence) or isinstance(point, str) or len(point) != 2:
        raise InputError(name, point, "not a pair [q, p]")
    q, p = rational(point[0], name), rational(point[1], name)
    for value in (q, p):
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > MAX_BITS:
            raise InputError(name, value, f"has more than {MAX_BITS} bits")
    return q, p


def _check(corners: Sequence[Point], name: str) -> None:
    count = len(corners)
    for k in range(count):
        if corners[k] == corners[k - 1]:
            raise _wrong(name, corners, k, f"is the same as point {k or count}")
    whole = _whole(corners, name)
    if on_a_line(whole):
        raise InputError(name, f"{count} points", "all on one line")
    for k in range(count):
        if turns_back(whole[k - 1], whole[k], whole[(k + 1) % count]):
            raise _wrong(name, corners, k, "the polygon goes back there on its own side")
    for i, j in meetings(whole):
        to = (j + 1) % count + 1
        raise _wrong(name, corners, i, f"the side from it meets the one from point {j + 1} to {to}")


def _whole(corners: Sequence[Point], name: str) -> list[tuple[int, int]]:
    """The points times their common denominator, so that thousands of sides are soon compared."""
    common = lcm(*(value.denominator for corner in corners for value in corner))
    if common.bit_length() > MAX_COMMON_BITS:
        problem = f"the common denominator has more than {MAX_COMMON_BITS} bits"
        raise InputError(name, f"{len(corners)} points", problem)
    return [(int(x * common), int(y * common)) for x, y in corners]


def _wrong(name: str, corners: Sequence[Point], k: int, problem: str) -> InputError:
    return InputError(f"{name} point {k + 1}", ", ".join(map(text, corners[k])), problem)
