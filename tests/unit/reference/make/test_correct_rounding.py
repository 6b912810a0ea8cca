"""A number's text depends on the number alone, and its radius on the text."""

import random
from fractions import Fraction

import pytest

from verify.reference.make.row_values import correctly_rounded, exactly, near_zero
from verify.scenes.results.reference import Rounded


def nearest(value: Fraction, digits: int) -> Fraction:
    """By trying exponents, and Python's own rounding."""
    exponent = -400
    while abs(value) >= Fraction(10) ** (exponent + 1):
        exponent += 1
    unit = Fraction(10) ** (exponent - digits + 1)
    return round(value / unit) * unit


@pytest.mark.parametrize("seed", range(200))
def test_it_is_the_nearest_decimal_and_the_number_is_within_half_a_unit(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311 - no secret
    value = Fraction(draw.randrange(-(10**40), 10**40), draw.randrange(1, 10**25))
    value *= Fraction(10) ** draw.randrange(-300, 300)
    digits = draw.randrange(1, 25)
    found = correctly_rounded(value, abs(value) / 10**40, digits)
    assert found is not None
    assert Fraction(found.value) == nearest(value, digits)
    off = abs(Fraction(found.value) - value)
    assert off <= Fraction(found.radius)
    assert Fraction(found.radius) * 2 == Fraction(10) ** round_exponent(found)


def round_exponent(found: Rounded) -> int:
    mantissa, _, exponent = found.value.partition("e")
    return int(exponent) - len(mantissa.partition(".")[2])


@pytest.mark.parametrize("seed", range(50))
def test_it_does_not_depend_on_the_bound(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311 - no secret
    value = Fraction(draw.randrange(1, 10**30), draw.randrange(1, 10**12))
    bounds = [value / 10**n for n in (20, 25, 40)]
    moved = [value + draw.choice((-1, 1)) * b * Fraction(9, 10) for b in bounds]
    texts = {correctly_rounded(x, b, 12) for x, b in zip(moved, bounds, strict=True)}
    assert len(texts - {None}) == 1


def test_a_number_in_the_middle_gets_one_digit_more() -> None:
    tie = Fraction("1.2345")
    for bound in (Fraction(0), Fraction(1, 10**20)):
        found = correctly_rounded(tie, bound, 4)
        assert found == Rounded(value="1.2345e+00", radius="5e-05")
    assert correctly_rounded(tie + Fraction(1, 10**9), Fraction(1, 10**20), 4) == Rounded(
        value="1.235e+00", radius="5e-04"
    )


def test_an_exact_number_that_is_short_is_itself() -> None:
    assert correctly_rounded(Fraction("0.1"), Fraction(0), 30) == exactly(Fraction("0.1"))
    assert exactly(Fraction(-1500)) == Rounded(value="-1.5e+03", radius="0")
    assert exactly(Fraction(0)) == Rounded(value="0", radius="0")
    third = correctly_rounded(Fraction(1, 3), Fraction(0), 5)
    assert third == Rounded(value="3.3333e-01", radius="5e-06")


def test_a_carry_moves_the_exponent_and_the_radius() -> None:
    found = correctly_rounded(Fraction("9.99996"), Fraction(1, 10**12), 4)
    assert found == Rounded(value="1.000e+01", radius="5e-03")


def test_what_is_not_known_well_enough_has_no_text() -> None:
    assert correctly_rounded(Fraction("1.23456"), Fraction(1, 1000), 5) is None
    assert correctly_rounded(Fraction(1, 10), Fraction(1), 5) is None
    assert correctly_rounded(Fraction(0), Fraction(1, 10), 5) is None


def test_zero_is_zero_to_twice_the_digits_of_what_it_is_small_against() -> None:
    tiny = Fraction(1, 10**30)
    assert near_zero(tiny, tiny, 10, Fraction(1)) == Rounded(value="0", radius="1e-20")
    assert near_zero(tiny, tiny, 10, Fraction(0)) == Rounded(value="0", radius="1e-20")
    assert near_zero(tiny, tiny, 10, Fraction(1, 10**20)) is None
