"""A number known within a bound → the one decimal that it rounds to, where there is only one.

The text and its radius then depend on the number alone and not on how it was found: whoever
computes it again, with any bound that is small enough, gets the same text.
"""

from fractions import Fraction
from itertools import count

from verify.arithmetic.exact import decimal, magnitude, rounded_units
from verify.scenes.results.reference import Rounded

_TOUCH = 20  # digits beyond those asked for, within which an exact number is looked at like others


def correctly_rounded(value: Fraction, bound: Fraction, digits: int) -> Rounded | None:
    """Return the decimal of so many significant digits that is nearest to every number within
    `bound`.

    Of one digit more where the number is halfway between two of them, as exact decimals can be.
    An exact number (`bound` 0) that has no more digits than that is given itself, with radius 0.
    None where the bound is too large to tell, and so wherever it reaches 0.

    >>> correctly_rounded(Fraction(1, 3), Fraction(1, 10**6), 4)
    Rounded(value='3.333e-01', radius='5e-05')
    >>> correctly_rounded(Fraction(1, 3), Fraction(1, 10**4), 4)
    >>> correctly_rounded(Fraction(1, 4), Fraction(0), 4)
    Rounded(value='2.5e-01', radius='0')
    """
    if bound == 0 and _short(value, digits):
        return exactly(value)
    # An exact number with more digits is treated like one with a tiny bound: so the text does not
    # depend on whether the number was known exactly.
    tolerance = bound or abs(value) / Fraction(10) ** (digits + _TOUCH)
    low, high = value - tolerance, value + tolerance
    if low <= 0 <= high:
        return None
    for many in (digits, digits + 1):
        text = decimal(low, many)
        if text == decimal(high, many):
            last = magnitude(Fraction(text)) - many + 1  # 9.99… may have become 1.00…e+01
            return Rounded(value=text, radius=f"5e{last - 1:+03d}")
    return None


def near_zero(value: Fraction, bound: Fraction, digits: int, size: Fraction) -> Rounded | None:
    """Return 0 ± 10^(−2·digits) times the power of ten in `size`; None where more may be left than
    that.

    `size`: what the number is small against, such as the initial value; 0 counts as 1.

    >>> near_zero(Fraction(0), Fraction(1, 10**20), 8, Fraction(2))
    Rounded(value='0', radius='1e-16')
    """
    exponent = (magnitude(size) if size else 0) - 2 * digits
    if abs(value) + bound > Fraction(10) ** exponent:
        return None
    return Rounded(value="0", radius=f"1e{exponent:+03d}")


def exactly(value: Fraction) -> Rounded:
    """Return a number whose decimals end, with all of them and radius 0.

    >>> exactly(Fraction(-1, 8))
    Rounded(value='-1.25e-01', radius='0')
    """
    if value == 0:
        return Rounded(value="0", radius="0")
    digits = next(n for n in count(1) if _short(value, n))
    return Rounded(value=decimal(value, digits), radius="0")


def _short(value: Fraction, digits: int) -> bool:
    """Return True if a decimal of so many significant digits is that number."""
    if value == 0:
        return True
    units, exponent = rounded_units(value, digits)
    return units * Fraction(10) ** exponent == value
