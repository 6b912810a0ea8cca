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
# The largest binary exponent that is converted to a rational: a ball's exponent has no limit, and a
# rational with a huge one would fill the memory.
_MAX_EXPONENT = 1 << 17


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
    return all(abs(int(exponent)) <= _MAX_EXPONENT for _, exponent in parts)


def midpoint_and_radius(x: Ball) -> tuple[Fraction, Fraction]:
    """Return the ball's midpoint and radius as exact rationals.

    If a binary exponent is below −2^17, they are those of a wider ball, which contains this one.
    Raises OverflowError if an exponent is above 2^17: the rational would fill all memory.
    """
    midpoint, midpoint_error = _rational(*x.mid().man_exp())
    radius, radius_error = _rational(*flint.arb(x.rad()).man_exp())
    return midpoint, radius + midpoint_error + radius_error


def _rational(mantissa: flint.fmpz, exponent: flint.fmpz) -> tuple[Fraction, Fraction]:
    """Return (the number, 0); or (0, a bound on its size) if its exponent is too small."""
    numerator, power = int(mantissa), int(exponent)
    if power > _MAX_EXPONENT:
        raise OverflowError("a ball is too large for a rational")
    # 2^power has more bits than a computer can hold; it is replaced by an interval around 0 that
    # contains it, which keeps the enclosure rigorous.
    if power < -_MAX_EXPONENT:
        return Fraction(0), Fraction(abs(numerator), 1 << _MAX_EXPONENT)
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
    """Return the decimal with `places` places to which both ends of the ball round; else the known
    digits of the ball."""
    if not is_representable(x):
        return "unknown"
    low, high = bounds(x)
    unit = Fraction(1, 10**places)
    if round(low / unit) != round(high / unit):
        return format_ball(x)
    return decimal_of_units(round(low / unit), places)


def decimal_of_units(units: int, places: int) -> str:
    """Return units · 10^−places as a decimal; `places` is at least 1.

    >>> decimal_of_units(-12345, 2)
    '-123.45'
    """
    digits = f"{abs(units):0{places + 1}d}"
    return f"{'-' if units < 0 else ''}{digits[:-places]}.{digits[-places:]}"


def slope(points: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the least-squares slope of y over x and its standard error, for three points (x, y) or
    more."""
    count = len(points)
    mean_x = sum(x for x, _ in points) / count
    mean_y = sum(y for _, y in points) / count
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    # Centred sums: without the means subtracted first, large x would cancel digits.
    gradient = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread
    squared_residuals = sum((y - mean_y - gradient * (x - mean_x)) ** 2 for x, y in points)
    return float(gradient), float((squared_residuals / (count - 2) / spread) ** 0.5)
