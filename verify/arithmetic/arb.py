"""Measured values as balls (flint.arb): the printed value with its bound as radius."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from fractions import Fraction
from typing import Protocol

import flint

from verify.arithmetic.exact import known_text
from verify.arithmetic.flint_precision import working_precision

Ball = flint.arb
UNKNOWN = flint.arb.nan()
_BITS = 256
_MOST_EXPONENT = 1 << 17  # of what becomes a rational; a ball's exponent may itself be astronomical


class Reported(Protocol):
    """A number with a bound of its error, both as decimals."""

    @property
    def value(self) -> str: ...

    @property
    def bound(self) -> str: ...


def precision() -> AbstractContextManager[None]:
    """Set ball arithmetic with enough bits for anything float64 can give."""
    return working_precision(_BITS)


def rational_ball(value: Fraction) -> Ball:
    """Return the narrowest ball around a rational, at flint's present precision."""
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


def ball(value: Reported) -> Ball:
    """Return the ball of a reported value and its bound."""
    return make_ball(Fraction(value.value), Fraction(value.bound))


def make_ball(midpoint: Fraction, radius: Fraction) -> Ball:
    """Return the ball of that midpoint and radius."""
    return rational_ball(midpoint) + flint.arb(0, 1) * rational_ball(radius)


def lg(x: Ball) -> Ball:
    """Return the decimal logarithm; not finite if x may be 0 or negative."""
    return x.log() / flint.arb(10).log()


def is_representable(x: Ball) -> bool:
    """Return True if the ball is finite, and its ends are rationals that a computer can hold."""
    if not x.is_finite():
        return False
    parts = x.mid().man_exp(), flint.arb(x.rad()).man_exp()
    return all(abs(int(exponent)) <= _MOST_EXPONENT for _, exponent in parts)


def midpoint_and_radius(x: Ball) -> tuple[Fraction, Fraction]:
    """Return the ball's midpoint and radius as exact rationals; of one that is too small those of a
    wider one around 0.

    Raises OverflowError for one that is too large: as a rational it would fill all memory.
    """
    midpoint, midpoint_error = _rational(*x.mid().man_exp())
    radius, radius_error = _rational(*flint.arb(x.rad()).man_exp())
    return midpoint, radius + midpoint_error + radius_error


def _rational(mantissa: flint.fmpz, exponent: flint.fmpz) -> tuple[Fraction, Fraction]:
    """Return the number, and 0; or, if it is too small, 0 and a bound of its size."""
    numerator, power = int(mantissa), int(exponent)
    if power > _MOST_EXPONENT:
        raise OverflowError("a ball is too large for a rational")
    # 2^power has more bits than a computer can hold; it is replaced by an interval around 0 that
    # contains it, which keeps the enclosure rigorous.
    if power < -_MOST_EXPONENT:
        return Fraction(0), Fraction(abs(numerator), 1 << _MOST_EXPONENT)
    number = Fraction(numerator << power) if power > 0 else Fraction(numerator, 1 << -power)
    return number, Fraction(0)


def bounds(x: Ball) -> tuple[Fraction, Fraction]:
    """Return the ball's end points as exact rationals; it must be representable."""
    midpoint, radius = midpoint_and_radius(x)
    return midpoint - radius, midpoint + radius


def format_ball(x: Ball, digits: int = 6) -> str:
    """Return the known digits of a ball, at most `digits`, in scientific notation."""
    if not is_representable(x):
        return "unknown"
    low, high = bounds(x)
    return known_text((low + high) / 2, (high - low) / 2, digits)


def format_fixed(x: Ball, places: int) -> str:
    """Return the ball's midpoint with so many decimal places, if both its ends round to it."""
    if not is_representable(x):
        return "unknown"
    low, high = bounds(x)
    unit = Fraction(1, 10**places)
    if round(low / unit) != round(high / unit):
        return format_ball(x)
    return decimal_of_units(round(low / unit), places)


def decimal_of_units(units: int, places: int) -> str:
    """Write an integer number of 10^−places as a decimal.

    >>> place(-12345, 2)
    '-123.45'
    """
    digits = f"{abs(units):0{places + 1}d}"
    return f"{'-' if units < 0 else ''}{digits[:-places]}.{digits[-places:]}"


def slope(points: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the least-squares slope of y over x and its standard error, of at least three
    points."""
    count = len(points)
    mean_x = sum(x for x, _ in points) / count
    mean_y = sum(y for _, y in points) / count
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    # Centred sums: without the means subtracted first, large x would cancel digits.
    gradient = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread
    squared_residuals = sum((y - mean_y - gradient * (x - mean_x)) ** 2 for x, y in points)
    return float(gradient), float((squared_residuals / (count - 2) / spread) ** 0.5)
