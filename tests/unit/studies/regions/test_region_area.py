"""Changes of areas by maps, held against exact values."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.known_areas import (
    CAT,
    CHANGED,
    CIRCLE,
    DUFFING,
    PENDULUM,
    SQUARE,
    WIDE_GOAL,
    MadePlane,
    floats,
    linear_determinant,
    measured,
    placed,
    wide,
)
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.shapes.outline import Outline
from verify.schemes import get
from verify.studies.regions.region_area import Goal

ROUNDED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 4))  # where float64's digits are used up


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
    assert true.rounding_error < found.rounding_error / 10**9


@pytest.mark.left_to_ci
def test_what_rounding_leaves_is_within_its_bound_after_every_cut_too() -> None:
    """No cut makes a difference smaller that is rounding's: it is cut until the nodes are used."""
    outline, given = placed(CIRCLE, *TINY), ("lie3", Fraction(1, 10), 20, PENDULUM)
    found, true = (measured(outline, plane(*given), CHANGED) for plane in (floats, wide))
    assert found.nodes > 100 * true.nodes
    assert abs(found.change - true.change) <= found.error + true.error
