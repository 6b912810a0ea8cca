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


TINY, HUGE = "1/1048576", "262144"


@pytest.mark.parametrize(
    ("text", "sizes"),
    [
        # The scale of u is hidden beside the far larger v, and that of v beside u.
        (f"u_dot = u*(v/({HUGE}) - 2); v_dot = v*(1 - u/({TINY}))", (TINY, HUGE)),
        # A spring whose v is far larger than x, as time has another unit; and it is damped.
        (f"v_dot = -{HUGE}*(x/({TINY}) + x**3/({TINY})**3) - v/8; x_dot = ({TINY})*v/{HUGE}",
         (HUGE, TINY)),
        # Without any scale, x' = y w and so on, the shares of the three are such that all are as
        # fast, and their product stays 1: w is 2⁻² of y, and x 2⁻¹.
        ("x_dot = 2*y*w; y_dot = 8*x*w; w_dot = x*y/2", ("1", "2", "1/2")),
    ],
)  # fmt: skip
def test_each_coordinate_has_a_unit_of_its_own(text: str, sizes: tuple[str, ...]) -> None:
    for unit, size in zip(units(text), map(Fraction, sizes), strict=True):
        assert size / 8 <= unit <= size * 8


def test_the_number_of_coordinates_may_be_odd() -> None:
    found = units("x_dot = sin(w) + cos(y); y_dot = sin(x) + cos(w); w_dot = sin(y) + cos(x)")
    assert len(found) == 3
    assert all(Fraction(1, 10) <= x <= 10 for x in found)
