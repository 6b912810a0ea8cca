"""Numbers in lines: what is written is read back, and what is no number is told."""

import ctypes
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.integrators.foreign.lines import (
    format_line,
    format_memory,
    parse_line,
    parse_memory,
    parse_number,
)
from verify.integrators.user_code.step import StepError
from verify.integrators.user_code.user_map import (
    DOUBLE,
    DOUBLE_DOUBLE,
    FLOAT128,
    LONG_DOUBLE,
    TYPES,
    NumberType,
)

FLOATS = st.floats(-1e6, 1e6, allow_nan=False).map(Fraction)


@given(FLOATS, FLOATS, st.sampled_from(sorted(TYPES)))
def test_what_is_written_is_read_back(x: Fraction, y: Fraction, name: str) -> None:
    kind = TYPES[name]
    made = [kind.round_number(x + y / 3**40), kind.round_number(y)]
    assert parse_memory(format_memory(made, kind), 2, kind) == made
    assert [
        kind.round_number(Fraction(x)) for x in parse_line(format_line(made, kind), 2, kind)
    ] == made


@given(FLOATS, FLOATS, st.sampled_from([DOUBLE, LONG_DOUBLE, FLOAT128]))
def test_a_rounded_number_is_the_nearest_of_its_bits(
    x: Fraction, y: Fraction, kind: object
) -> None:
    assert isinstance(kind, type(DOUBLE))
    exact = x + y / 3**40
    made = kind.round_number(exact)
    assert kind.round_number(made) == made
    if exact:
        assert abs(made - exact) <= abs(exact) * Fraction(1, 2**kind.bits) + Fraction(1, 2**1074)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1), ("-0.5", Fraction(-1, 2)), ("1.5e-3", Fraction(3, 2000)), ("2.5D2", 250),
        ("0x1.8p1", 3), ("-0X1P-3", Fraction(-1, 8)), ("+.5", Fraction(1, 2)), ("1.", 1),
        ("0x.8p0", Fraction(1, 2)), ("1.25Q0", Fraction(5, 4)),
    ],
)  # fmt: skip
def test_decimals_and_hexadecimal_floats_are_numbers(text: str, value: Fraction) -> None:
    assert parse_number(text) == value


@pytest.mark.parametrize(
    "text", ["", ".", "x", "0x", "1e", "1,5", "nan", "-inf", "1e99999", "0x1p99999", "1" * 300, "١"]
)
def test_what_is_no_number_is_told(text: str) -> None:
    with pytest.raises(StepError, match="answers"):
        parse_number(text)


@pytest.mark.parametrize(
    ("line", "kind"), [("1", DOUBLE), ("1 2 3", DOUBLE), ("", DOUBLE), ("1 2", DOUBLE_DOUBLE)]
)
def test_another_count_of_numbers_is_told(line: str, kind: object) -> None:
    assert isinstance(kind, type(DOUBLE))
    with pytest.raises(StepError, match="wanted"):
        parse_line(line, 2, kind)


# -- as C has them in memory ----------------------------------------------------------------------


@given(FLOATS, FLOATS)
def test_what_is_no_number_of_the_type_is_rounded(x: Fraction, y: Fraction) -> None:
    exact = x + y / 3**40
    for kind in (DOUBLE, LONG_DOUBLE, FLOAT128):
        assert parse_memory(format_memory([exact], kind), 1, kind) == [kind.round_number(exact)]


@pytest.mark.parametrize("power", [-1000, -1, 0, 1, 52])
@pytest.mark.parametrize("kind", [DOUBLE, LONG_DOUBLE, FLOAT128])
def test_what_is_just_below_a_power_of_two_is_rounded_up_to_it(
    kind: NumberType, power: int
) -> None:
    """All bits of its significand carry, and it has one bit more."""
    two = Fraction(2) ** power
    for more in (2, 3, 100):
        above = two * (1 - Fraction(1, 2 ** (kind.bits + more)))
        assert parse_memory(format_memory([above, -above], kind), 2, kind) == [two, -two]
    last = two * (1 - Fraction(1, 2**kind.bits))  # the number before it
    assert parse_memory(format_memory([last, -last], kind), 2, kind) == [last, -last]


def test_a_long_double_is_that_of_c() -> None:
    """By ctypes, which knows it, though it gives it to Python as a double."""
    for x in (1.5, -0.1, 3e100, 2.0**-1000, 0.0):
        raw = bytes(ctypes.c_longdouble(x))[:10]
        assert bytes.fromhex(format_memory([Fraction(x)], LONG_DOUBLE))[:10] == raw


def test_what_is_too_small_is_zero() -> None:
    for kind in (LONG_DOUBLE, FLOAT128):
        assert parse_memory(format_memory([Fraction(1, 2**17000)], kind), 1, kind) == [0]


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
        parse_memory(digits, 1, kind)
