"""A reported value as a number: what it is equal to, and what is certain of it."""

from decimal import Decimal
from fractions import Fraction
from operator import ge, gt, le, lt

import mpmath
import numpy as np
import pytest

from verify.scenes.results.bounded_value import Value

X = Value(value="1.50e-03", bound="2.00e-05")
ZERO = Value(value="0", bound="0")
BIG = "1.2345678901234567890123456789e-400"


@pytest.mark.parametrize(
    ("other", "less", "more"),
    [
        (0.0016, True, False),
        (0.0014, False, True),
        (0.00151, False, False),  # within the bound: neither is known
        (0.0015, False, False),
        (np.float64(1), True, False),
        (-1, False, True),
        (Fraction(1, 600), True, False),
        (Decimal("0.0015201"), True, False),
        (mpmath.mpf("0.0014"), False, True),
        (Value(value="1.60e-03", bound="7.00e-05"), True, False),
        (Value(value="1.60e-03", bound="9.00e-05"), False, False),
    ],
)
def test_a_comparison_is_true_where_it_holds_for_all_numbers_within_the_bounds(
    other: object, less: bool, more: bool
) -> None:
    assert (lt(X, other), gt(X, other)) == (less, more)
    assert (le(X, other), ge(X, other)) == (less, more)
    assert (gt(other, X), lt(other, X)) == (less, more)


def test_the_ends_belong_to_the_numbers_that_it_may_be() -> None:
    assert X.ends == (Fraction("0.00148"), Fraction("0.00152"))
    assert le(X, 0.00152)
    assert not lt(X, 0.00152)


def test_only_an_exact_value_is_equal_to_a_number() -> None:
    assert ZERO == 0
    assert Value(value="0", bound="0") == ZERO
    assert hash(ZERO) == hash(0)
    assert X != 0.0015
    assert Value(value="1.50e-03", bound="2.00e-05") == X
    assert Value(value="1.50e-03", bound="0") not in (X, 0)
    assert X != "1.50e-03"
    assert len({X, Value(value="1.50e-03", bound="2.00e-05"), ZERO, 0}) == 2


@pytest.mark.parametrize("other", ["1", None, [1], float("nan"), complex(1)])
def test_what_is_no_number_is_not_compared(other: object) -> None:
    assert other != X
    with pytest.raises(TypeError):
        lt(X, other)


def test_it_is_a_number_wherever_one_is_wanted() -> None:
    assert float(X) == 0.0015
    assert np.array([X, ZERO], dtype=float).tolist() == [0.0015, 0]
    assert f"{X:.1e}" == "1.5e-03"
    assert f"{X} {X!r}" == "1.50e-03 ± 2.00e-05 Value(1.50e-03 ± 2.00e-05)"
    assert str(ZERO) == "0"
    assert float(-X) == -0.0015
    negative = -X
    assert abs(negative) == X == -negative
    assert -ZERO == ZERO


def test_mpmath_takes_it_whole() -> None:
    with mpmath.workdps(30):
        found = mpmath.mpf(Value(value=BIG, bound="0"))
        assert found == mpmath.mpf(BIG)
        assert mpmath.log10(Value(value="1e-400", bound="0")) == -400
    assert mpmath.mp.dps == 15


@pytest.mark.parametrize(
    ("value", "bound", "shown"),
    [
        ("1.50e-03", "2.00e-05", "1.50e-03 ± 2.00e-05"),
        ("0", "0", "0"),
        ("7", "0", "7"),
        ("0", "2.63e+343", "|·| ≤ 2.63e+343"),
    ],
)
def test_what_no_digit_is_known_of_is_not_shown_as_a_number(
    value: str, bound: str, shown: str
) -> None:
    found = Value(value=value, bound=bound)
    assert str(found) == shown
    assert found.unknown == shown.startswith("|")
