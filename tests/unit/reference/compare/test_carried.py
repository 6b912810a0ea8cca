"""How far rounding is carried is what the formula says, each term by itself."""

from fractions import Fraction
from math import isqrt
from types import SimpleNamespace
from typing import Any

import pytest

from verify.reference.compare.scatter import CarriedRounding, _Row
from verify.reference.compare.table_agreement import DOUBLE

NAMES = ("p1", "p2", "q1", "q2")
SIZE = Fraction(3, 2)


def carried_at(rows: dict[int, Any], step: int) -> Any:
    made = object.__new__(CarriedRounding)
    hamiltonian = SimpleNamespace(coordinates=NAMES, degrees=2)
    vars(made).update(_orbit=SimpleNamespace(hamiltonian=hamiltonian), _rows=rows)
    return made.spreads_at(step)


@pytest.mark.parametrize("step", [1, 9, 100, 5000])
def test_a_rounding_at_each_step_is_carried_as_far_as_the_farthest(step: int) -> None:
    """Usually √N of them add up, at worst all do; a program rounds products of entries, too."""
    early = {n: Fraction(k + 1, 7) for k, n in enumerate((*NAMES, "lambda"))}
    late = {n: Fraction(9 - k, 8) for k, n in enumerate((*NAMES, "lambda", "symplectic_defect"))}
    rows = {
        0: _Row(SIZE, {}, Fraction(1)),
        step - 1: _Row(SIZE, early, Fraction(5)),
        step: _Row(SIZE, late, Fraction(3)),
        step + 1: _Row(SIZE, late, Fraction(99)),
    }
    found, many = carried_at(rows, step), 1 + isqrt(step)
    largest = max(row.entry for n, row in rows.items() if n <= step)
    products = {"symplectic_defect_max": Fraction(8), "symplectic_defect": largest**2,
                "lambda": largest**2}  # fmt: skip
    for name in (*NAMES, *products):
        by = max(row.carried.get(name, 0) for n, row in rows.items() if n <= step)
        product = products.get(name, 0)
        assert found[name].usual == many * (by + product)
        assert found[name].worst == 4 * (step + 1) * by + many**2 * product / 2


def test_where_rounding_may_have_moved_the_orbit_nothing_is_said() -> None:
    """Beyond a thousandth of its size errors do not just add up."""
    limit = SIZE / 1000 / DOUBLE / 10
    for by, said in ((limit * Fraction(99, 100), True), (limit * Fraction(101, 100), False)):
        rows = {0: _Row(SIZE, {}, Fraction(1)), 10: _Row(SIZE, {"q2": by}, Fraction(1))}
        assert (carried_at(rows, 10) is not None) is said
    assert carried_at({3: None}, 3) is None
