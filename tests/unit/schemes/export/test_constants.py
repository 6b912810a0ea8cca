"""Constants in exported code: the nearest double, and enclosures that hold it."""

import math
from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.errors import LimitError
from verify.schemes.export.constants import Constants, constant


@drawn(40)
@given(st.fractions(min_value=Fraction(1, 10**20), max_value=10**20))
def test_a_rational_number_is_rounded_to_the_nearest_double(value: Fraction) -> None:
    found = constant("c", sympy.Rational(value.numerator, value.denominator))
    near = Fraction(float(found.literal))
    below, above = _neighbours(float(near))
    assert abs(near - value) <= min(abs(below - value), abs(above - value))
    assert found.exactly == (near == value)
    assert Fraction(found.exact.replace(" ", "")) == value


def _neighbours(x: float) -> tuple[Fraction, Fraction]:
    return Fraction(math.nextafter(x, -math.inf)), Fraction(math.nextafter(x, math.inf))


NUMBERS = [sympy.cbrt(2), sympy.sqrt(3) / 6 - 1, 1 / (2 - sympy.cbrt(2)), sympy.pi, sympy.exp(1)]


@pytest.mark.parametrize("number", NUMBERS)
def test_an_irrational_number_is_enclosed_to_more_than_17_digits(number: sympy.Expr) -> None:
    found = constant("c", number)
    low, high = (sympy.Rational(x) for x in found.enclosure)
    assert (low < number) == (number < high) == True  # noqa: E712 - sympy's own truth
    assert (high - low) / abs(low) < sympy.Rational(1, 10**17)
    near = sympy.Rational(Fraction(float(found.literal)))
    for other in _neighbours(float(found.literal)):
        assert abs(near - number) < abs(sympy.Rational(other) - number)


def test_a_number_without_a_double_is_refused() -> None:
    for number in (sympy.Rational(1, 10**400), sympy.Integer(10) ** 400, 10**400 * sympy.sqrt(2)):
        with pytest.raises(LimitError, match="outside of the range"):
            constant("c", number)


def test_each_number_is_taken_out_once_with_its_sign_before() -> None:
    x, y = sympy.symbols("x y", real=True)
    found = Constants(lambda k: f"c{k}")
    third, root = sympy.Rational(1, 3), sympy.cbrt(2)
    left = found.extract(third * x - third * y**2 + root * x / 5 + 7 * sympy.sqrt(x) + 2)
    assert {c.exact for c in found} == {"1/3", "2**(1/3)/5"}
    values = {sympy.Symbol(c.name, real=True): sympy.sympify(c.exact) for c in found}
    gap = left.subs(values) - (third * x - third * y**2 + root * x / 5 + 7 * sympy.sqrt(x) + 2)
    assert sympy.simplify(gap) == 0
    assert not left.has(sympy.Rational(1, 3))
