"""A user's own polygon: what it draws, and what is refused, against every pair of its sides."""

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.arithmetic.float_context import FLOAT
from verify.errors import InputError
from verify.scenes.shapes.user_outline import MAX_POINTS, polygon

TRIANGLE = [["0", "0"], ["2", "0"], ["1/3", "0.7"]]


def test_a_polygon_has_its_corners_and_goes_round_counterclockwise() -> None:
    (outline,) = polygon(TRIANGLE).outlines
    (turned,) = polygon(TRIANGLE[::-1]).outlines
    mp = mpmath.MPContext()
    mp.dps = 40
    corners = {arc(mp, mp.mpf(0)) for arc in outline.arcs}
    assert corners == {(0, 0), (2, 0), (mp.mpf(1) / 3, mp.mpf(7) / 10)}
    for each in (outline, turned):
        points = [complex(*map(float, arc(FLOAT, 0.0))) for arc in each.arcs]
        area = sum((a.conjugate() * b).imag for a, b in pairwise([*points, points[0]]))
        assert area == pytest.approx(1.4), "twice the area"


@pytest.mark.parametrize(
    "points",
    [
        TRIANGLE,
        [[0, 0], [1, 0], [2, 0], [2, 2]],  # a corner on a side
        [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]],
        [[0, 0], [4, 0], [4, 4], [2, "1e-100"], [0, 4]],  # nearly touching
        [[round(10 * math.cos(k)), round(10 * math.sin(k))] for k in range(6)],
        [(0, 0), (1, 0), (0, 1)],
    ],
)
def test_simple_polygons_are_taken(points: list[list[Any]]) -> None:
    assert len(polygon(points).outlines[0].arcs) == len(points)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ("abc", r"polygon=abc: not a list of points"),
        (7, r"polygon=7: not a list of points"),
        ([[0, 0], [1, 1]], r"polygon=2: points; allowed: 3 … 2000"),
        ([[k, k * k] for k in range(MAX_POINTS + 1)], r"polygon=2001: points; allowed: 3"),
        ([[0, 0], [1, 1], [3, 3]], r"polygon=3 points: all on one line"),
        ([[0, 0], [1, 0], 5], r"polygon point 3=5: not a pair \[q, p\]"),
        ([[0, 0], [1, 0], "12"], r"polygon point 3=12: not a pair"),
        ([[0, 0], [1, 0, 0], [0, 1]], r"polygon point 2=\[1, 0, 0\]: not a pair"),
        ([[0, 0], [1, "x"], [0, 1]], r"polygon point 2=x: not a finite number"),
        ([[0, 0], [1, float("nan")], [0, 1]], r"polygon point 2=nan: not a finite number"),
        ([[0, 0], [1, True], [0, 1]], r"polygon point 2=True: not a number"),
        ([[0, 0], [1, 10**130], [0, 1]], r"polygon point 2=.*has more than 400 bits"),
        ([[0, 0], ["1.0", 0], [1, 0], [0, 1]], r"polygon point 3=1, 0: is the same as point 2"),
        ([[0, 0], [1, 0], [0, 1], [0, 0]], r"polygon point 1=0, 0: is the same as point 4"),
        ([[0, 0], [2, 0], [1, 0], [0, 1]], r"polygon point 2=2, 0: the polygon goes back"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], r"point 1=0, 0: the side from it meets .* 3 to 4"),
        ([[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], r"point 1=0, 0: the side from it meets"),
        ([[0, 0], [4, 0], [4, 4], [2, "-1e-100"], [0, 4]], r"point 1=0, 0: the side from it meets"),
        ([[0, 0], [2, 2], [4, 0], [4, 4], [2, 2], [0, 4]], r"the side from it meets"),
        ([[0, 0], [5, 0], [5, 1], [4, 0], [3, 0], [0, 1]], r"point 1=0, 0: the side from it meets"),
        ([[f"1/{10**9 + k}", k * k] for k in range(200)], r"the common denominator"),
    ],
)
def test_a_bad_polygon_is_refused_by_its_point(points: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        polygon(points)


@given(st.lists(st.tuples(st.integers(-4, 4), st.integers(-4, 4)), min_size=3, max_size=7))
def test_what_is_refused_crosses_itself_and_what_is_taken_does_not(corners: list[Any]) -> None:
    """Against every pair of sides, solved for the two parameters of their common point."""
    try:
        polygon(corners)
        taken = True
    except InputError:
        taken = False
    assert taken == simple(corners)


def simple(corners: list[tuple[int, int]]) -> bool:
    n = len(corners)
    sides = [(corners[k], corners[(k + 1) % n]) for k in range(n)]
    if any(a == b for a, b in sides):
        return False
    for i in range(n):
        for j in range(i + 1, n):
            common = shared(*sides[i], *sides[j])
            neighbours = {corners[j]} if j == i + 1 else {corners[i]} if (j + 1) % n == i else set()
            if n == 3 or neighbours:
                if common is None or not common <= {*sides[i]} & {*sides[j]}:
                    return False
            elif common is None or common:
                return False
    return True


def shared(a: Any, b: Any, c: Any, d: Any) -> set[tuple[Fraction, Fraction]] | None:
    """The points that two sides share; None where they are more than one."""
    ab, cd, ac = ((v[0] - u[0], v[1] - u[1]) for u, v in ((a, b), (c, d), (a, c)))
    det = ab[0] * cd[1] - ab[1] * cd[0]
    if det:
        s = Fraction(ac[0] * cd[1] - ac[1] * cd[0], det)
        t = Fraction(ac[0] * ab[1] - ac[1] * ab[0], det)
        inside = 0 <= s <= 1 and 0 <= t <= 1
        return {(a[0] + s * ab[0], a[1] + s * ab[1])} if inside else set()
    if ab[0] * ac[1] != ab[1] * ac[0]:
        return set()
    length = ab[0] ** 2 + ab[1] ** 2
    ends = sorted(Fraction((z[0] - a[0]) * ab[0] + (z[1] - a[1]) * ab[1], length) for z in (c, d))
    low, high = max(ends[0], Fraction(0)), min(ends[1], Fraction(1))
    if low > high:
        return set()
    return {(a[0] + low * ab[0], a[1] + low * ab[1])} if low == high else None
