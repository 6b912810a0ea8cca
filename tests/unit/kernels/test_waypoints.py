"""A longer way goes on from where points are known to have got to, with the same bits."""

from fractions import Fraction

import numpy as np
import pytest

from tests.helpers.known_areas import DUFFING
from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels import many_points
from verify.kernels.many_points import PointMap, Waypoints

DRIVEN = Hamiltonian.parse("p**2/2 + q**4/4 - q*cos(t)")
SHORT, LONG = 600, 1300
Array = np.ndarray


def added(calls: list[tuple[int, int]], steps: int, carried: Array) -> Array:
    """A step adds 1 to all that is carried; what was asked for is noted."""
    calls.append((steps, carried.shape[1]))
    return carried + steps


def asked(known: Waypoints, carried: Array, steps: int) -> list[tuple[int, int]]:
    """(steps, points) of each call; the result is that of a way without a stop."""
    calls: list[tuple[int, int]] = []
    found = known.advance_points(carried, steps, lambda n, z: added(calls, n, z))
    assert np.array_equal(found, carried + steps)
    return sorted(calls)


def cloud(count: int) -> Array:
    """Points whose sums with whole numbers are exact."""
    return np.random.default_rng(8).integers(-64, 64, (2, count)) / 64


def test_what_is_known_goes_on_and_what_is_new_begins() -> None:
    known, points = Waypoints(True), cloud(7)
    assert asked(known, points[:, :4], SHORT) == [(SHORT, 4)]
    assert asked(known, points, LONG) == [(LONG - SHORT, 4), (LONG, 3)]
    assert asked(known, points, LONG) == []
    assert asked(known, points, LONG + 1) == [(1, 7)]


def test_a_shorter_way_begins_anew() -> None:
    known, points = Waypoints(True), cloud(3)
    asked(known, points, LONG)
    assert asked(known, points, SHORT) == [(SHORT, 3)]
    assert asked(known, points, LONG) == []  # the farthest is what is kept


def test_a_step_that_is_the_first_is_one_only() -> None:
    known, points = Waypoints(False), cloud(2)
    asked(known, points, SHORT)
    assert asked(known, points, LONG) == [(LONG, 2)]


def test_a_short_way_is_not_noted() -> None:
    known, points = Waypoints(True), cloud(2)
    asked(known, points, 5)
    assert asked(known, points, LONG) == [(LONG, 2)]


def test_no_more_points_are_kept_than_there_is_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    # A point has two numbers.
    monkeypatch.setattr(many_points, "_MAX_CACHED_NUMBERS", 2 * 2)
    known, points = Waypoints(True), cloud(3)
    asked(known, points, SHORT)
    assert asked(known, points, LONG) == [(LONG - SHORT, 2), (LONG, 1)]


def test_a_point_that_is_given_twice_is_followed_like_any_other() -> None:
    known, points = Waypoints(True), np.repeat(cloud(2), 2, axis=1)
    asked(known, points, SHORT)
    assert asked(known, points, LONG) == [(LONG - SHORT, 4)]


@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "compensated", "observables"),
    [
        (DUFFING, "lie2", False, {"lambda"}),
        (DUFFING, "stormer-verlet", True, set()),
        (DUFFING, "gauss4", False, set()),
        (DRIVEN, "lie2", False, set()),
    ],
)
def test_a_map_after_another_one_has_the_bits_that_it_has_alone(
    hamiltonian: Hamiltonian, scheme: str, compensated: bool, observables: set[str]
) -> None:
    q, p = cloud(40)

    def states(steps: int) -> list[Array]:
        made = PointMap(
            hamiltonian, scheme, step_size=Fraction(1, 50), steps=steps, t0=Fraction(1, 3),
            arithmetic=arithmetic.get("float64", 17), observables=frozenset(observables),
            compensated=compensated,
        )  # fmt: skip
        return list(made(q=q, p=p).values())

    many_points.waypoints_of.cache_clear()
    alone = states(LONG)
    many_points.waypoints_of.cache_clear()
    states(SHORT)
    assert all(map(np.array_equal, states(LONG), alone))


def test_other_step_sizes_are_other_ways() -> None:
    q, p = cloud(5)

    def ends(h: Fraction) -> Array:
        made = PointMap(
            DUFFING, "lie2", step_size=h, steps=SHORT, arithmetic=arithmetic.get("float64", 17)
        )
        return np.asarray(made(q=q, p=p)["q"])

    many_points.waypoints_of.cache_clear()
    small, large = ends(Fraction(1, 100)), ends(Fraction(1, 50))
    many_points.waypoints_of.cache_clear()
    assert np.array_equal(ends(Fraction(1, 50)), large)
    assert not np.array_equal(small, large)
