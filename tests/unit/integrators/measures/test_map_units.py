"""The units in which a map is looked at: how far from 0 its Jacobian has changed."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from verify.integrators.measures.map_units import _has_changed, find_map_units
from verify.integrators.user_code.loading import callee_from


def test_one_entry_that_moves_by_a_tenth_of_the_largest_is_a_change() -> None:
    still = [[1.0, 0.0], [2.0, 1.0]]
    for row in (0, 1):
        for column in (0, 1):
            moved = [list(x) for x in still]
            moved[row][column] += 0.3
            assert _has_changed(still, moved)
            moved[row][column] = still[row][column] + 0.1
            assert not _has_changed(still, moved)
    assert not _has_changed(still, still)


@pytest.mark.parametrize("unit", ["1/1000", "1", "300"])
def test_the_unit_of_a_map_is_its_own_length(unit: str) -> None:
    """q + a² sin(q/a) bends where q is of the size of a."""
    length = float(Fraction(unit))

    def turned(p: Any, q: Any) -> tuple[Any, Any]:
        return p + length * np.sin(q / length), q

    found = find_map_units(callee_from(turned, ("p", "q"), stepped=False).step)
    assert all(length / 8 <= float(x) <= 8 * length for x in found)


@pytest.mark.parametrize("take", [lambda x: x, float], ids=["duals", "floats"])
def test_coordinates_that_differ_by_far_have_units_of_their_own(take: Any) -> None:
    def kicked(p: Any, q: Any) -> tuple[Any, Any]:
        p = take(p) - 1e6 * np.sin(take(q) / 1e-3)
        return p, take(q) + 1e-9 * p

    p, q = find_map_units(callee_from(kicked, ("p", "q"), stepped=False).step)
    assert 1e8 < p / q < 1e12
    if take is not float:
        assert 1e-4 < float(q) < 1e-2
