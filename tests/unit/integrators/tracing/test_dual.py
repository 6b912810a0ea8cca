"""Dual numbers carry the derivatives of each operation, by mpmath's; two directions at once."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest

from verify.integrators.tracing.dual import Duals
from verify.integrators.tracing.traced_number import UntraceableError

MP = mpmath.mp.clone()
MP.dps = 60
POINTS = [(Fraction(3, 7), Fraction(5, 3)), (Fraction(9, 4), Fraction(1, 11)),
          (Fraction(13, 5), Fraction(-7, 2))]  # fmt: skip
# As a user writes it, and as mpmath has it, of x > 0 and y.
Case = tuple[Callable[[Any, Any], Any], Callable[[Any, Any], Any]]
OPERATIONS: dict[str, Case] = {
    "add": (lambda x, y: x + y + 1, lambda x, y: x + y + 1),
    "subtract": (lambda x, y: 2 - x - y, lambda x, y: 2 - x - y),
    "multiply": (lambda x, y: x * y * 3, lambda x, y: x * y * 3),
    "square": (lambda x, y: x * x + y * y, lambda x, y: x * x + y * y),
    "divide": (lambda x, y: x / y, lambda x, y: x / y),
    "divide by a constant": (lambda x, y: (x - y) / 7, lambda x, y: (x - y) / 7),
    "a constant divided": (lambda x, y: 7 / (x * y), lambda x, y: 7 / (x * y)),
    "negative": (lambda x, y: -x * y, lambda x, y: -x * y),
    "absolute": (lambda x, y: abs(y) * x, lambda x, y: abs(y) * x),
    "reversed": (lambda x, y: (5 - x) * (1 + y), lambda x, y: (5 - x) * (1 + y)),
    "sin": (lambda x, y: np.sin(x * y), lambda x, y: MP.sin(x * y)),
    "cos": (lambda x, y: np.cos(x * y), lambda x, y: MP.cos(x * y)),
    "tan": (lambda x, y: np.tan(x * y), lambda x, y: MP.tan(x * y)),
    "exp": (lambda x, y: np.exp(x * y / 4), lambda x, y: MP.exp(x * y / 4)),
    "log": (lambda x, y: np.log(x) * y, lambda x, y: MP.log(x) * y),
    "sqrt": (lambda x, y: np.sqrt(x) * y, lambda x, y: MP.sqrt(x) * y),
    "sinh": (lambda x, y: np.sinh(x * y / 4), lambda x, y: MP.sinh(x * y / 4)),
    "cosh": (lambda x, y: np.cosh(x * y / 4), lambda x, y: MP.cosh(x * y / 4)),
    "tanh": (lambda x, y: np.tanh(x * y / 4), lambda x, y: MP.tanh(x * y / 4)),
    "arctan": (lambda x, y: np.arctan(x * y), lambda x, y: MP.atan(x * y)),
    "a power of a constant": (lambda x, y: 3 ** (x * y / 4), lambda x, y: MP.mpf(3) ** (x * y / 4)),
    **{
        f"to the power {n}": (lambda x, y, n=n: (x * y) ** n, lambda x, y, n=n: (x * y) ** n)
        for n in (-5, -3, -2, -1, 0, 1, 2, 3, 4, 7)
    },
    **{
        f"to the power {n}": (
            lambda x, y, n=n: x**n * y,
            lambda x, y, n=n: x ** (MP.mpf(n.numerator) / n.denominator) * y,
        )
        for n in (Fraction(1, 2), Fraction(-3, 2), Fraction(5, 3), Fraction(7, 4))
    },
}  # fmt: skip


def as_mp(x: Fraction) -> Any:
    return MP.mpf(x.numerator) / x.denominator


@pytest.mark.parametrize("point", POINTS)
@pytest.mark.parametrize("name", OPERATIONS)
def test_an_operation_has_the_value_and_both_derivatives_that_mpmath_has(
    name: str, point: tuple[Fraction, Fraction]
) -> None:
    mine, theirs = OPERATIONS[name]
    kind, (x, y) = Duals(), point
    with kind.running():
        found = mine(*kind.state(x, y))
        value, slopes = MP.mpf(str(found.value)), [MP.mpf(str(s)) for s in found.slopes]
    at = as_mp(x), as_mp(y)
    wanted = [MP.diff(theirs, at, n) for n in ((1, 0), (0, 1))]
    assert abs(value - theirs(*at)) < MP.mpf(10) ** -45 * (1 + abs(value))
    slopes = slopes or [MP.mpf(0)] * 2  # of a constant there are none
    for found_slope, slope in zip(slopes, wanted, strict=True):
        assert abs(found_slope - slope) < MP.mpf(10) ** -25 * (1 + abs(slope))


def test_what_has_no_value_or_no_derivative_is_refused() -> None:
    kind = Duals()
    with kind.running():
        zero, minus = kind.state(Fraction(0), Fraction(-1))
        for broken in (lambda: zero**-1, lambda: 1 / zero, lambda: minus / zero):
            with pytest.raises(ZeroDivisionError):
                broken()
        for broken in (lambda: np.sqrt(minus), lambda: np.log(zero), lambda: np.log(minus)):
            with pytest.raises(ValueError, match="math domain error"):
                broken()
        with pytest.raises(UntraceableError, match="root of a number that is not positive"):
            minus ** Fraction(1, 2)


def test_finite_numbers_are_told_from_others() -> None:
    kind = Duals()
    with kind.running():
        (one,) = kind.state(Fraction(1))
        endless = np.exp(one * 10**12) * np.exp(one * 10**12)
        for number in (one, -one, one - one):
            assert np.isfinite(number)
            assert not np.isnan(number)
        huge = endless
        for _ in range(40):
            huge = huge * huge
        assert not np.isfinite(huge)
        assert np.isnan(huge - huge)
