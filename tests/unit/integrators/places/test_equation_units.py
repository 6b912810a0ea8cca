"""The units of equations are where their field turns, in any units of the coordinates."""

from fractions import Fraction

import pytest

from verify.hamiltonians.equations import read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.equation_units import units_of_system
from verify.integrators.places.units import FloatField, units_of

LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"


def units(text: str) -> list[Fraction]:
    (found,), _ = units_of_system(FloatField(read_system(text)))
    return found


def test_those_of_a_hamiltonian_are_as_before() -> None:
    field = FloatField(Hamiltonian.parse("p**2/2 - cos(q)"))
    assert units_of_system(field) == units_of(field)


def test_a_coordinate_has_the_scale_at_which_its_field_turns() -> None:
    assert all(Fraction(1, 2) <= x <= 5 for x in units(LOTKA))
    # Where the field has no scale, 1 is taken.
    assert units("x_dot = y; y_dot = -x") == [1, 1]


@pytest.mark.parametrize("unit", ["1000000", "1/1000000"])
def test_in_other_units_the_units_are_others(unit: str) -> None:
    scaled = f"u_dot = u*(v/({unit}) - 2); v_dot = v*(1 - u/({unit}))"
    size = Fraction(unit)
    assert all(size / 8 <= x <= size * 8 for x in units(scaled))


def test_the_number_of_coordinates_may_be_odd() -> None:
    found = units("x_dot = sin(w) + cos(y); y_dot = sin(x) + cos(w); w_dot = sin(y) + cos(x)")
    assert len(found) == 3
    assert all(Fraction(1, 10) <= x <= 10 for x in found)
