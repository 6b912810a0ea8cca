"""Numbers in lines: what is written is read back, and what is no number is told."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.integrators.foreign.lines import line_of, number_of, numbers_of
from verify.integrators.user_code.number_type import (
    DOUBLE,
    DOUBLE_DOUBLE,
    FLOAT128,
    LONG_DOUBLE,
    TYPES,
)
from verify.integrators.user_code.step import StepError

FLOATS = st.floats(-1e6, 1e6, allow_nan=False).map(Fraction)


@given(FLOATS, FLOATS, st.sampled_from(sorted(TYPES)))
def test_what_is_written_is_read_back(x: Fraction, y: Fraction, name: str) -> None:
    kind = TYPES[name]
    made = kind.rounded(x + y / 3**40)
    found = numbers_of(line_of([made], kind), 1, kind)[0]
    assert kind.rounded(found) == made


@given(FLOATS, FLOATS, st.sampled_from([DOUBLE, LONG_DOUBLE, FLOAT128]))
def test_a_rounded_number_is_the_nearest_of_its_bits(
    x: Fraction, y: Fraction, kind: object
) -> None:
    assert isinstance(kind, type(DOUBLE))
    exact = x + y / 3**40
    made = kind.rounded(exact)
    assert kind.rounded(made) == made
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
    assert number_of(text) == value


@pytest.mark.parametrize(
    "text", ["", ".", "x", "0x", "1e", "1,5", "nan", "-inf", "1e99999", "0x1p99999", "1" * 300, "١"]
)
def test_what_is_no_number_is_told(text: str) -> None:
    with pytest.raises(StepError, match="answers"):
        number_of(text)


@pytest.mark.parametrize(
    ("line", "kind"), [("1", DOUBLE), ("1 2 3", DOUBLE), ("", DOUBLE), ("1 2", DOUBLE_DOUBLE)]
)
def test_another_count_of_numbers_is_told(line: str, kind: object) -> None:
    assert isinstance(kind, type(DOUBLE))
    with pytest.raises(StepError, match="wanted"):
        numbers_of(line, 2, kind)
