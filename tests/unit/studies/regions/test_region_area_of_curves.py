"""Areas of curves, held against exact values."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.known_areas import (
    CHANGED,
    CIRCLE,
    DUFFING,
    WIDE_GOAL,
    bezier_area,
    floats,
    measured,
    pi,
    placed,
    polygon,
    shoelace,
    still,
    wide,
)
from verify.scenes.shapes.outline import Arc, Outline, angle, bezier
from verify.scenes.shapes.user_outline import svg_path
from verify.studies.regions.region_area import NoAreaError

TRIANGLE = ((0, 0), (3, 1), (Fraction(1, 3), 2))
ZIGZAG = ((0, 0), (2, 0), (2, 2), (1, Fraction(1, 2)), (0, 2))


def ellipse(mp: Any, s: Any) -> tuple[Any, Any]:
    turn = angle(mp, s)
    return 3 * mp.cos(turn) + 2, mp.sin(turn) / 2 - 1


def cardioid(mp: Any, s: Any) -> tuple[Any, Any]:
    """r = 1 − cos θ, whose cusp is in the middle of the arc."""
    turn = angle(mp, s)
    r = 1 - mp.cos(turn)
    return r * mp.cos(turn), r * mp.sin(turn)


def turned(arc: Arc) -> Arc:
    return lambda mp, s: arc(mp, 1 - s)


CURVES = [
    (CIRCLE, Fraction(1)),
    (Outline("ellipse", (ellipse,)), Fraction(3, 2)),
    (Outline("cardioid", (cardioid,)), Fraction(3, 2)),
]


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("outline", "times"), CURVES, ids=["circle", "ellipse", "cardioid"])
def test_smooth_curves_have_their_areas_to_all_digits(outline: Outline, times: Fraction) -> None:
    true = pi(times)
    found = measured(outline, still())
    assert abs(found.area / true - 1) <= found.error < 1e-14
    fine = measured(outline, wide("lie1", Fraction(1, 2), 1), WIDE_GOAL)
    assert abs(fine.area / true - 1) < Fraction(1, 10**30)
    assert abs(fine.area - true) <= fine.area * fine.error


@pytest.mark.left_to_ci
@pytest.mark.parametrize("corners", [TRIANGLE, ZIGZAG, ((-1, -1), (1, -1), (1, 1), (-1, 1))])
def test_polygons_have_the_area_of_the_shoelace_formula(corners: Any) -> None:
    for some, sign in ((corners, 1), (corners[::-1], -1)):
        found = measured(polygon(*some), still())
        assert abs(found.area - sign * shoelace(*corners)) < 4e-15
        fine = measured(polygon(*some), wide("lie1", Fraction(1, 2), 1), WIDE_GOAL)
        assert abs(fine.area - sign * shoelace(*corners)) < Fraction(1, 10**31)


def test_a_path_of_bezier_curves_has_its_area_by_exact_integration() -> None:
    leaf = ((0, 0), (10, 20), (30, 20), (40, 0)), ((40, 0), (20, -30), (0, 0))
    arcs = [tuple((Fraction(x), Fraction(y)) for x, y in arc) for arc in leaf]
    (drawn,) = svg_path("M 0 0 C 10 -20 30 -20 40 0 Q 20 30 0 0 Z").outlines
    for outline in (drawn, Outline("leaf", tuple(bezier(*arc) for arc in arcs))):
        found = measured(outline, wide("lie1", Fraction(1, 2), 1), WIDE_GOAL)
        assert abs(found.area / bezier_area(*arcs) - 1) < Fraction(1, 10**30)
        assert abs(measured(outline, still()).area / bezier_area(*arcs) - 1) < 1e-14


def test_a_clockwise_curve_has_the_opposite_area_and_the_same_change() -> None:
    other = Outline("turned", tuple(turned(arc) for arc in reversed(CIRCLE.arcs)))
    plane = floats("lie2", Fraction(1, 10), 30, DUFFING)
    one, two = (measured(placed(x, 1, 0, "1/4"), plane, CHANGED) for x in (CIRCLE, other))
    assert abs(one.area + two.area) < 1e-14
    assert abs(one.change - two.change) <= one.error + two.error


def test_a_curve_that_bounds_no_area_is_told() -> None:
    eight = Outline("eight", (lambda mp, s: (mp.sin(angle(mp, s)), mp.sin(2 * angle(mp, s))),))
    with pytest.raises(NoAreaError, match=r"eight bounds no area"):
        measured(eight, still())
    lopsided = polygon((-1, -1), (-1, 1), (2, -2), (2, 2))
    assert abs(measured(lopsided, still()).area) > Fraction(1, 2)
