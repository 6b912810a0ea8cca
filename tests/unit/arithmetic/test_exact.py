"""User numbers to exact rationals, and back to decimals whose every digit is known."""

from decimal import Decimal
from fractions import Fraction

import numpy
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.arithmetic.exact import (
    decimal,
    known_digits,
    magnitude,
    positive,
    rational,
    text,
    upper,
    whole,
)
from verify.errors import InputError

quick = drawn(150)


def scaled() -> st.SearchStrategy[Fraction]:
    """Fractions over many orders of magnitude."""
    sizes = st.integers(-60, 60).map(lambda e: Fraction(10) ** e)
    return st.builds(lambda f, s: f * s, st.fractions(max_denominator=10**9), sizes)


bounds = scaled().map(abs)

VALUES = {
    "integer": (7, Fraction(7)),
    "integer text": ("7", Fraction(7)),
    "decimal": ("0.001", Fraction(1, 1000)),
    "no leading zero": (".5", Fraction(1, 2)),
    "no trailing digits": ("5.", Fraction(5)),
    "scientific": ("1e-3", Fraction(1, 1000)),
    "capital exponent": ("-2.5E+2", Fraction(-250)),
    "quotient": ("7/3", Fraction(7, 3)),
    "signed": ("+1/4", Fraction(1, 4)),
    "decimal over integer": ("1.5/2", Fraction(3, 4)),
    "space around": ("  1/8\n", Fraction(1, 8)),
    "fraction": (Fraction(2, 6), Fraction(1, 3)),
    "Decimal": (Decimal("0.1"), Fraction(1, 10)),
    "Decimal with exponent": (Decimal("1E+5"), Fraction(10**5)),
    "negative zero": (Decimal("-0"), Fraction(0)),
    "beyond a float's digits": ("0.1234567890123456789", Fraction(1234567890123456789, 10**19)),
    "largest exponent": ("1e1000", Fraction(10**1000)),
}


@pytest.mark.parametrize(("given_value", "exact"), VALUES.values(), ids=VALUES.keys())
def test_a_number_is_taken_exactly(given_value: object, exact: Fraction) -> None:
    taken = rational(given_value)  # type: ignore[arg-type]
    assert (taken, type(taken)) == (exact, Fraction)


REFUSED = {
    "true": True,
    "false": False,
    "none": None,
    "complex": 1 + 0j,
    "bytes": b"1",
    "list": [1],
    "float nan": float("nan"),
    "float infinity": float("inf"),
    "float minus infinity": float("-inf"),
    "Decimal nan": Decimal("NaN"),
    "Decimal signalling nan": Decimal("sNaN"),
    "Decimal infinity": Decimal("Infinity"),
    "numpy nan": numpy.float64("nan"),
    "numpy boolean": numpy.True_,
    "text nan": "nan",
    "text infinity": "-inf",
    "empty": "",
    "blank": "  ",
    "point alone": ".",
    "exponent alone": "e5",
    "exponent empty": "1e",
    "two signs": "--1",
    "space inside": "1 / 3",
    "hexadecimal": "0x10",
    "grouped": "1_000",
    "name": "pi",
    "formula": "1+1",
    "divided by zero": "1/0",
    "divided by zeros": "1/000",
    "nested quotient": "1/2/3",
    "other digits": "\u0663",
    "huge exponent": "1e1001",
    "tiny exponent": "1e-1001",
    "very huge exponent": "1e" + "9" * 500,
    "long": "1" * 3000,
    "long with a point": "1." + "1" * 3000,
    "long quotient": "1/" + "1" * 3000,
    "longer than Python reads": "1" * 4500,
    "longer than anybody writes": "1" * 10**6,
    "long Decimal": Decimal("1" * 3000),
    "long integer": 10**3000,
    "integer that Python does not print": 10**5000,
    "long below": Fraction(1, 10**3000),
}


@pytest.mark.parametrize("value", REFUSED.values(), ids=REFUSED.keys())
def test_what_is_not_a_finite_number_is_one_clear_line(value: object) -> None:
    with pytest.raises(InputError, match=r"^mass=") as info:
        rational(value, "mass")  # type: ignore[arg-type]
    assert "\n" not in str(info.value)
    assert len(str(info.value)) < 200


@pytest.mark.parametrize("value", [0.001, 0.1, 1e23, -0.3, 0.5, 0.0, 3.0, 2.0**40, 5e-324])
def test_a_float_stands_for_the_decimal_that_it_prints_as(value: float) -> None:
    """As a check of a step function takes it, a file and the command line do."""
    assert rational(value) == rational(numpy.float64(value)) == Fraction(repr(value))


def test_a_binary_value_is_meant_where_a_fraction_says_so() -> None:
    assert rational(Fraction(0.1)) == Fraction(*(0.1).as_integer_ratio()) != rational(0.1)
    assert rational(0.1 + 0.2) == Fraction("0.30000000000000004")


def test_numbers_of_numpy_are_read_like_those_of_python() -> None:
    assert rational(numpy.float32(0.1)) == Fraction(1, 10)
    assert rational(numpy.int64(7)) == whole("steps", numpy.uint8(7), 1) == 7
    assert rational(numpy.int64(2**62)) * 4 == 2**64
    assert type(whole("steps", numpy.int64(7), 1)) is int
    for wrong in (numpy.bool_(1), numpy.float64("nan"), numpy.float32("inf"), numpy.array([1.0])):
        with pytest.raises(InputError, match=r"^mass="):
            rational(wrong, "mass")
    for no_count in (numpy.float64(7), numpy.bool_(1), numpy.int64(0)):
        with pytest.raises(InputError, match="must be a whole number"):
            whole("steps", no_count, 1)


@pytest.mark.parametrize("value", ["0", 0, "-1e-30", -0.5, Fraction(-1, 3), "0/7"])
def test_positive_refuses_zero_and_below(value: object) -> None:
    with pytest.raises(InputError, match=r"^h=.*greater than 0"):
        positive(value, "h")  # type: ignore[arg-type]


def test_positive_gives_the_exact_value() -> None:
    assert positive("1e-30", "h") == Fraction(1, 10**30)


def test_an_error_can_show_a_number_of_any_length() -> None:
    with pytest.raises(InputError, match=r"^h=") as info:
        positive(-(10**5000), "h")
    assert len(str(info.value)) < 200


# -- text -------------------------------------------------------------------------------------

TEXTS = {
    "0": Fraction(0),
    "7": Fraction(7),
    "-12": Fraction(-12),
    "0.001": Fraction(1, 1000),
    "-0.125": Fraction(-1, 8),
    "10.5": Fraction(21, 2),
    "1/3": Fraction(1, 3),
    "-22/7": Fraction(-22, 7),
}


@pytest.mark.parametrize(("shown", "value"), TEXTS.items(), ids=TEXTS.keys())
def test_text_is_a_decimal_where_it_ends_and_a_quotient_else(shown: str, value: Fraction) -> None:
    assert text(value) == shown


@quick
@given(scaled())
@example(Fraction(1, 2**21))
@example(Fraction(10**25))
@example(Fraction(10**1000))
@example(Fraction(-1, 10**1000))
@example(Fraction(2**8000 - 1, 2**7999 + 1))
def test_text_reads_back_as_the_same_number(value: Fraction) -> None:
    assert Fraction(text(value)) == value
    assert rational(text(value)) == value


# -- decimal ----------------------------------------------------------------------------------

DECIMALS = {
    "half to even, down": (Fraction(125), 2, "1.2e+02"),
    "half to even, up": (Fraction(135), 2, "1.4e+02"),
    "one digit": (Fraction(-26), 1, "-3e+01"),
    "rounded to the next power": (Fraction(9999, 1000), 3, "1.00e+01"),
    "small": (Fraction(1, 3000), 4, "3.333e-04"),
    "zero": (Fraction(0), 5, "0"),
    "long exponent": (Fraction(10) ** 123, 2, "1.0e+123"),
}


@pytest.mark.parametrize(("value", "digits", "shown"), DECIMALS.values(), ids=DECIMALS.keys())
def test_decimal_is_scientific_with_that_many_digits(
    value: Fraction, digits: int, shown: str
) -> None:
    assert decimal(value, digits) == shown


@quick
@given(scaled(), st.integers(1, 60))
def test_a_printed_decimal_is_within_half_a_unit(value: Fraction, digits: int) -> None:
    assume(value != 0)
    printed = decimal(value, digits)
    mantissa = printed.lstrip("-").partition("e")[0]
    assert len(mantissa.replace(".", "")) == digits
    unit = Fraction(10) ** (magnitude(value) - digits + 1)
    assert abs(Fraction(printed) - value) <= unit / 2


def test_more_digits_than_python_prints_by_default_can_be_asked_for() -> None:
    printed = decimal(Fraction(1, 3), 5000)
    assert printed == "3." + "3" * 4999 + "e-01"


@quick
@given(scaled())
@example(Fraction(1))
@example(Fraction(999, 1000))
@example(Fraction(10) ** 3000)
@example(Fraction(10) ** -3000)
@example(Fraction(10**3000 - 1))
def test_magnitude_is_the_decimal_exponent(value: Fraction) -> None:
    assume(value != 0)
    exponent = magnitude(value)
    assert Fraction(10) ** exponent <= abs(value) < Fraction(10) ** (exponent + 1)


# -- known digits -----------------------------------------------------------------------------


@quick
@given(scaled(), bounds, st.integers(1, 40), st.fractions(-1, 1))
@example(Fraction(0), Fraction(0), 5, Fraction(0))
@example(Fraction(0), Fraction(1, 7), 5, Fraction(1))
@example(Fraction(9999), Fraction(1, 2), 4, Fraction(1))
@example(Fraction(9996, 1000), Fraction(1, 100), 3, Fraction(1))
def test_the_true_value_is_within_the_printed_bound(
    value: Fraction, bound: Fraction, most: int, where: Fraction
) -> None:
    printed, printed_bound = known_digits(value, bound, most)
    true = value + where * bound
    assert abs(Fraction(printed) - true) <= Fraction(printed_bound)


@quick
@given(scaled(), bounds, st.integers(1, 40))
@example(Fraction(9), Fraction(4), 10)
@example(Fraction(1), Fraction(1, 2), 5)
def test_the_last_printed_digit_is_known(value: Fraction, bound: Fraction, most: int) -> None:
    printed, _ = known_digits(value, bound, most)
    assume(printed != "0")
    mantissa, _, exponent = printed.lstrip("-").partition("e")
    places = len(mantissa.partition(".")[2])
    assert places + 1 <= most
    assert Fraction(10) ** (int(exponent) - places) >= 2 * bound


@quick
@given(scaled(), st.integers(1, 30))
def test_an_exact_value_prints_all_digits_asked_for(value: Fraction, most: int) -> None:
    printed, bound = known_digits(value, Fraction(0), most)
    assert printed == decimal(value, most)
    assert Fraction(bound) >= abs(value - Fraction(printed))


def test_no_known_digit_prints_as_zero_within_all_that_it_may_be() -> None:
    assert known_digits(Fraction(-1, 10), Fraction(1), 5) == ("0", "1.10e+00")


@quick
@given(bounds)
@example(Fraction(9991, 10))
@example(Fraction(100))
def test_upper_is_never_below_and_at_most_one_per_cent_above(bound: Fraction) -> None:
    printed = Fraction(upper(bound))
    assert bound <= printed <= bound * Fraction(101, 100)


@pytest.mark.parametrize("written", ["1e3", "1,000", "1_000.0", 1000.0, Decimal("1e3")])
def test_a_count_that_is_no_whole_number_in_print_is_told_as_one(written: object) -> None:
    with pytest.raises(InputError, match=r"whole number, 1 … 2000; write 1000$"):
        whole("steps", written, 1, 2000)


@pytest.mark.parametrize("written", ["1.5", "-1e3", "1e4", "1e2000", "x", 0, 2001, True, None])
def test_of_what_is_no_count_of_the_range_none_is_told(written: object) -> None:
    with pytest.raises(InputError, match=r"must be a whole number, 1 … 2000$"):
        whole("steps", written, 1, 2000)


def test_a_count_of_too_many_digits_to_print_is_refused_all_the_same() -> None:
    with pytest.raises(InputError, match=r"must be a whole number, 1 … 2000$"):
        whole("steps", 10**5000, 1, 2000)
