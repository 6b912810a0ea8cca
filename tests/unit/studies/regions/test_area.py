"""Areas of curves and their change by maps, held against exact values; planted errors are seen."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest

from tests.helpers.known_areas import (
    DUFFING,
    PENDULUM,
    MadePlane,
    bezier_area,
    floats,
    linear_determinant,
    measured,
    polygon,
    shoelace,
    still,
    wide,
)
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.shapes import named as shapes
from verify.scenes.shapes.outline import Arc, Outline, angle, bezier
from verify.scenes.shapes.user_outline import svg_path
from verify.schemes import get
from verify.studies.regions import area as area_probe
from verify.studies.regions.area import Goal, Measured, NoAreaError, Probe

WIDE_GOAL = Goal(change=Fraction(0), area=Fraction(1, 10**27))
CHANGED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 10**14))
ROUNDED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 4))  # where float64's digits are used up
CIRCLE, SQUARE, CAT = (shapes.get(name).outlines[0] for name in ("circle", "square", "cat"))
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


def pi(times: Fraction) -> Fraction:
    with mpmath.workdps(60):
        return Fraction(mpmath.nstr(mpmath.pi, 55)) * times


def placed(outline: Outline, q: Any, p: Any, scale: Any) -> Outline:
    return outline.placed(Fraction(q), Fraction(p), Fraction(scale))


# -- areas ----------------------------------------------------------------------------------------

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


# -- changes of area ------------------------------------------------------------------------------


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("scheme", "outline"),
    [("lie1", SQUARE), ("lie2", CIRCLE), ("lie3", SQUARE), ("lie2", CAT), ("lie4", CIRCLE)],
)
def test_a_linear_map_changes_areas_by_its_determinant(scheme: str, outline: Outline) -> None:
    h, steps = Fraction(1, 20), 20 if outline is CAT else 100
    true = linear_determinant(scheme, h, steps)
    own = placed(outline, 2, -1, "3/2")
    found = measured(own, floats(scheme, h, steps))
    assert abs(found.change - true) <= found.error
    assert found.error < 1e-11
    if outline is CAT:  # many arcs, and below it is carried with 33 digits, too
        return
    fine = measured(own, wide(scheme, h, steps), WIDE_GOAL)
    assert abs(fine.change - true) <= fine.error < Fraction(1, 10**26)


SYMPLECTIC = ("symplectic-euler", "stormer-verlet", "gauss4", "yoshida4")


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("scheme", "hamiltonian"),
    list(zip(SYMPLECTIC, (DUFFING, PENDULUM, DUFFING, PENDULUM), strict=True)),
)
def test_what_preserves_area_changes_it_by_nothing_that_the_probe_can_tell(
    scheme: str, hamiltonian: Hamiltonian
) -> None:
    plane = floats(scheme, Fraction(1, 20), 100, hamiltonian)
    found = measured(placed(SQUARE, 1, 0, "1/4"), plane, Goal(Fraction(0), Fraction(1, 10**10)))
    assert abs(found.change) <= found.error < 1e-9


def test_where_it_does_not_a_change_as_small_as_that_would_be_seen() -> None:
    """The control of the test above: Störmer and Verlet's map but for one part in 10⁸ of its h."""

    def nearly(x: Any, y: Any) -> tuple[Any, Any]:
        h = x.dtype.type(1) / 20
        for _ in range(100):
            y = y - h / 2 * (x + x**3)
            x = x + h * y * (1 + x * x.dtype.type(1e-8))
            y = y - h / 2 * (x + x**3)
        return x, y

    goal = Goal(Fraction(0), Fraction(1, 10**10))
    found = measured(placed(SQUARE, 1, 0, "1/4"), MadePlane(nearly), goal)
    assert abs(found.change) > 100 * found.error


STEPPED = [
    ("lie1", "1/50", 50), ("lie2", "1/20", 100), ("lie2", "1/100", 400), ("lie3", "1/10", 60),
    ("lie4", "1/10", 60), ("rk4", "1/10", 60), ("symplectic-euler", "1/20", 100),
    ("stormer-verlet", "1/20", 100), ("explicit-midpoint", "1/50", 60),
]  # fmt: skip


TINY = (1, 1, "1/100000")
PLACES = [
    (DUFFING, (1, 0, "1/2"), CHANGED),
    (PENDULUM, (1, "1/2", "3/4"), CHANGED),
    (PENDULUM, TINY, ROUNDED),
]
# Each scheme at one place, and one of them at all.
CARRIED = [
    (place, stepped)
    for k, place in enumerate(PLACES)
    for n, stepped in enumerate(STEPPED)
    if n % 3 == k or stepped[0] == "lie3"
]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(("place", "stepped"), CARRIED)
def test_float64_lies_within_its_bound_of_33_digits(place: Any, stepped: Any) -> None:
    hamiltonian, where, asked = place
    scheme, h, steps = stepped
    outline = placed(CIRCLE, *where)
    found = measured(outline, floats(scheme, Fraction(h), steps, hamiltonian), asked)
    preserves = get(scheme).step_map(hamiltonian).preserves_area
    goal = Goal(Fraction(0), Fraction(1, 10**20)) if preserves else CHANGED
    true = measured(outline, wide(scheme, Fraction(h), steps, hamiltonian), goal)
    if preserves:
        assert abs(true.change) <= true.error
    assert abs(found.change - true.change) <= found.error + true.error
    assert true.rounded < found.rounded / 10**9


@pytest.mark.left_to_ci
def test_what_rounding_leaves_is_within_its_bound_after_every_cut_too() -> None:
    """No cut makes a difference smaller that is rounding's: it is cut until the nodes are used."""
    outline, given = placed(CIRCLE, *TINY), ("lie3", Fraction(1, 10), 20, PENDULUM)
    found, true = (measured(outline, plane(*given), CHANGED) for plane in (floats, wide))
    assert found.nodes > 100 * true.nodes
    assert abs(found.change - true.change) <= found.error + true.error


# -- corners and shear ----------------------------------------------------------------------------


def bent(x: Any, y: Any) -> tuple[Any, Any]:
    """(x, y + x²y), whose determinant is 1 + x²: the square's area grows by a third of itself."""
    return x, y + x * x * y


def test_panels_end_at_corners_and_corners_are_kept() -> None:
    found = measured(SQUARE, MadePlane(bent))
    assert abs(found.change - Fraction(1, 3)) <= found.error < 1e-12
    arcs = {panel.arc for panel in found.panels}
    assert arcs == {0, 1, 2, 3}
    for arc in arcs:
        own = [panel for panel in found.panels if panel.arc == arc]
        assert (own[0].left, own[-1].right) == (0, 1)
        assert all(a.right == b.left for a, b in pairwise(own))


def test_a_corner_that_is_rounded_off_is_seen() -> None:
    def smoothed(x: Any, y: Any) -> tuple[Any, Any]:
        near = np.hypot(x - 1, y - 1) < 0.01
        return np.where(near, x * 0.999, x), np.where(near, y * 0.999, y)

    right = measured(SQUARE, MadePlane(lambda x, y: (x + 0, y + 0)))
    wrong = measured(SQUARE, MadePlane(smoothed))
    assert right.change == 0
    assert abs(wrong.change) > 1e-6
    assert wrong.error > 1e3 * right.error, "what is not smooth between corners is seen to be so"


def sheared(turns: float) -> MadePlane:
    """By an angle that grows with the radius; area is preserved."""

    def twist(x: Any, y: Any) -> tuple[Any, Any]:
        by = turns * (x * x + y * y)
        return x * np.cos(by) - y * np.sin(by), x * np.sin(by) + y * np.cos(by)

    return MadePlane(twist)


def test_the_curve_is_refined_where_shear_stretches_it_and_the_error_stays() -> None:
    goal = Goal(Fraction(0), Fraction(1, 10**9))
    outline = placed(CIRCLE, 1, 0, "1/2")
    found = [measured(outline, sheared(turns), goal) for turns in (0.1, 10.0, 60.0)]
    assert found[0].nodes < found[1].nodes < found[2].nodes
    for one in found:
        assert abs(one.change) <= one.error < 2e-9
    lengths = [panel.right - panel.left for panel in found[2].panels]
    assert max(lengths) > min(lengths), "only where it is needed"


def test_too_few_nodes_are_told_by_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(area_probe, "_MOST_ROUNDS", 0)
    found = measured(placed(CIRCLE, 1, 0, "1/2"), sheared(60.0))
    assert abs(found.change) > 1e-6
    assert abs(found.change) <= found.error


def test_several_outlines_are_measured_as_each_by_itself() -> None:
    plane = floats("lie2", Fraction(1, 10), 30, DUFFING)
    outlines = [placed(CAT, 1, 0, "1/2"), placed(CIRCLE, 0, 1, "1/9")]
    both = Probe(outlines, plane, [CHANGED, CHANGED]).measure()
    for outline, one in zip(outlines, both, strict=True):
        alone = measured(outline, plane, CHANGED)
        assert abs(one.change - alone.change) <= one.error + alone.error
        assert abs(one.area - alone.area) < 1e-14


# -- planted errors -------------------------------------------------------------------------------


TRUE = linear_determinant("lie3", Fraction(1, 20), 40)


def test_a_panel_that_is_dropped_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Probe._measured

    def planted(self: Probe, families: Any, *rest: Any) -> Measured:
        return right(self, families[1:], *rest)

    monkeypatch.setattr(Probe, "_measured", planted)
    found = measured(SQUARE, MadePlane(bent))
    assert abs(found.change - Fraction(1, 3)) > 100 * found.error


def test_steps_that_are_wrong_by_one_are_seen() -> None:
    found = measured(placed(CIRCLE, 1, 0, "1/2"), floats("lie3", Fraction(1, 20), 41))
    assert abs(found.change - TRUE) > 100 * found.error
    assert abs(found.change - linear_determinant("lie3", Fraction(1, 20), 41)) <= found.error


@pytest.mark.left_to_ci
def test_a_wrong_number_of_the_rule_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = area_probe.rule

    def planted(bits: int) -> Any:
        made = right(bits)
        swept = made.swept.copy()
        swept[2, 3] += swept[2, 3] // 10**6
        return type(made)(made.bits, made.nodes, made.weights, made.derivative, swept)

    monkeypatch.setattr(area_probe, "rule", planted)
    area = measured(CIRCLE, still()).area
    assert abs(area / pi(Fraction(1)) - 1) > 1e-9


def test_rounding_is_measured_in_both_arithmetics() -> None:
    """A map that loses digits in float64 says so."""

    def lossy(x: Any, y: Any) -> tuple[Any, Any]:
        return (x + 1000) - 1000, y + 0

    found = measured(CIRCLE, MadePlane(lossy), Goal(Fraction(0), Fraction(1, 10**9)))
    assert abs(found.change) <= found.error
    assert found.rounded > 1e-13
    assert measured(CIRCLE, still()).rounded < 1e-15


def test_a_sample_of_panels_in_finer_arithmetic_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    outline = placed(CAT, 1, 0, "1/2")
    plane = wide("lie2", Fraction(1, 20), 40, DUFFING)
    few = measured(outline, plane, CHANGED)
    monkeypatch.setattr(plane, "sampled", 1 << 30)
    every = measured(outline, plane, CHANGED)
    assert few.change == every.change
    assert every.rounded / 8 <= few.rounded <= 8 * every.rounded
