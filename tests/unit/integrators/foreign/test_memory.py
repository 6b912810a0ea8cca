"""Numbers as C has them in memory: what is written is read back, and is what C reads."""

import ctypes
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.integrators.foreign.memory import digits_of, read_digits
from verify.integrators.user_code.number_type import (
    DOUBLE,
    DOUBLE_DOUBLE,
    FLOAT128,
    LONG_DOUBLE,
    TYPES,
    NumberType,
)
from verify.integrators.user_code.step import StepError

FLOATS = st.floats(-1e6, 1e6, allow_nan=False).map(Fraction)


@given(FLOATS, FLOATS, st.sampled_from(sorted(TYPES)))
def test_what_is_written_is_read_back(x: Fraction, y: Fraction, name: str) -> None:
    kind = TYPES[name]
    numbers = [kind.rounded(x + y / 3**40), kind.rounded(y)]
    assert read_digits(digits_of(numbers, kind), 2, kind) == numbers


@given(FLOATS, FLOATS)
def test_what_is_no_number_of_the_type_is_rounded(x: Fraction, y: Fraction) -> None:
    exact = x + y / 3**40
    for kind in (DOUBLE, LONG_DOUBLE, FLOAT128):
        assert read_digits(digits_of([exact], kind), 1, kind) == [kind.rounded(exact)]


@pytest.mark.parametrize("power", [-1000, -1, 0, 1, 52])
@pytest.mark.parametrize("kind", [DOUBLE, LONG_DOUBLE, FLOAT128])
def test_what_is_just_below_a_power_of_two_is_rounded_up_to_it(
    kind: NumberType, power: int
) -> None:
    """All bits of its significand carry, and it has one bit more."""
    two = Fraction(2) ** power
    for more in (2, 3, 100):
        above = two * (1 - Fraction(1, 2 ** (kind.bits + more)))
        assert read_digits(digits_of([above, -above], kind), 2, kind) == [two, -two]
    last = two * (1 - Fraction(1, 2**kind.bits))  # the number before it
    assert read_digits(digits_of([last, -last], kind), 2, kind) == [last, -last]


def test_a_long_double_is_that_of_c() -> None:
    """By ctypes, which knows it, though it gives it to Python as a double."""
    for x in (1.5, -0.1, 3e100, 2.0**-1000, 0.0):
        raw = bytes(ctypes.c_longdouble(x))[:10]
        assert bytes.fromhex(digits_of([Fraction(x)], LONG_DOUBLE))[:10] == raw


def test_what_is_too_small_is_zero() -> None:
    for kind in (LONG_DOUBLE, FLOAT128):
        assert read_digits(digits_of([Fraction(1, 2**17000)], kind), 1, kind) == [0]


@pytest.mark.parametrize(
    ("kind", "digits", "shown"),
    [
        (DOUBLE, bytes(ctypes.c_double(float("nan"))).hex(), "nan"),
        (DOUBLE, bytes(ctypes.c_double(float("-inf"))).hex(), "-inf"),
        (DOUBLE_DOUBLE, bytes((ctypes.c_double * 2)(1.0, float("inf"))).hex(), "inf"),
        (LONG_DOUBLE, (bytes(7) + b"\x80\xff\xff" + bytes(6)).hex(), "-inf"),
        (LONG_DOUBLE, (bytes(7) + b"\xc0\xff\x7f" + bytes(6)).hex(), "nan"),
        (FLOAT128, (bytes(14) + b"\xff\x7f").hex(), "inf"),
        (FLOAT128, (bytes(13) + b"\x80\xff\x7f").hex(), "nan"),
    ],
)
def test_what_is_not_finite_is_told(kind: NumberType, digits: str, shown: str) -> None:
    with pytest.raises(StepError, match=f"“{shown}”, which is not finite"):
        read_digits(digits, 1, kind)
