"""Users' numbers as exact rationals, and rationals as decimals whose every digit is known.

`0.001` written by a user is 1/1000, in Python as in a file or on the command line: a float stands
for the shortest decimal that Python reads back to it, which is what it prints. So `0.1` is 1/10,
and `0.1 + 0.2`, which Python has rounded, is 0.30000000000000004. To give a float's binary value,
write `Fraction(0.1)`; to give 1/3, write `"1/3"` or `Fraction(1, 3)`. numpy's numbers are read in
the same way, a float32 by its own shortest decimal.
"""

import re
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from numbers import Integral, Real
from typing import Any, Protocol, TypeGuard

import gmpy2

from verify.errors import InputError

Number = int | str | float | Decimal | Fraction
"""A user's number, as `rational` reads it: exact, or a float that stands for its decimal."""
NumberOrList = Number | Sequence[Number]
"""One number, or a list with one for each degree of freedom."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?(/\d+)?")
_MAX_EXPONENT = 1000
_MAX_BITS = 8000  # the limit for the numerator, and for the denominator
_MAX_LENGTH = 5000  # characters; two integers of 8000 bits have fewer together
_PLAIN_RANGE = Fraction(1, 1000), 10**4  # sizes that are printed without an exponent
_SHORT_LENGTH = 10  # characters


class Mpf(Protocol):
    """A finite number of mpmath: sign, mantissa, exponent and the mantissa's length."""

    @property
    def _mpf_(self) -> tuple[int, int, int, int]: ...


def rational(value: Number, name: str = "number") -> Fraction:
    """Return the exact value of a user's number.

    Strings may be decimals (`0.001`, `1e-3`) or quotients (`7/3`). Raises InputError for NaN,
    infinities, booleans, other types, exponents beyond ±1000, and more than 8000 bits. Therefore
    `rational` accepts what `text` writes of its results.

    >>> rational("0.1"), rational(0.1), rational("7/3")
    (Fraction(1, 10), Fraction(1, 10), Fraction(7, 3))
    """
    if _is_float(value):
        return _from_float(value, name)
    if isinstance(value, bool) or not isinstance(value, Number | Integral):
        raise InputError(name, value, "not a number; allowed: integers, decimals, quotients a/b")
    if isinstance(value, str | Decimal):
        number = _from_text(str(value), name)
    else:  # a numpy integer becomes Python's: it would overflow inside a Fraction
        number = Fraction(int(value) if isinstance(value, Integral) else value)
    if max(number.numerator.bit_length(), number.denominator.bit_length()) > _MAX_BITS:
        raise _too_long(name, value)
    return number


def positive(value: Number, name: str) -> Fraction:
    """Return the exact value. Raises InputError unless it is greater than 0."""
    number = rational(value, name)
    if number <= 0:
        raise InputError(name, value, "must be greater than 0")
    return number


def whole(name: str, value: object, least: int, most: int | None = None) -> int:
    """Return the value if it is a whole number from `least` to `most`; else raise InputError."""
    count = int(value) if isinstance(value, Integral) and not isinstance(value, bool) else None
    if count is None or count < least or (most is not None and count > most):
        range_text = f"{least} or more" if most is None else f"{least} … {most}"
        raise InputError(
            name, value, f"must be a whole number, {range_text}{as_whole(value, least, most)}"
        )
    return count


def as_whole(value: Any, least: int = 1, most: int | None = None) -> str:
    """Return advice to write 1e6, 10.0 or 1,000 as a whole number; empty if the value is none from
    `least` to `most` (without it 10^15)."""
    try:
        number = rational(re.sub("[,_]", "", value) if isinstance(value, str) else value)
    except InputError:
        return ""
    fits = number.denominator == 1 and least <= number <= (most or 10**15)
    return f"; write {number}" if fits and str(number) != value else ""


def _from_text(text: str, name: str) -> Fraction:
    stripped = text.strip()
    if len(stripped) > _MAX_LENGTH:
        raise _too_long(name, text)
    match = _NUMBER.fullmatch(stripped)
    # `\d` matches the digits of every script, but only ASCII digits are accepted.
    if match is None or not stripped.isascii():
        from verify.arithmetic.number_mistakes import number_mistake

        raise InputError(name, text, number_mistake(stripped))
    if match[2] and abs(int(match[2][1:])) > _MAX_EXPONENT:
        raise InputError(name, text, f"exponent beyond ±{_MAX_EXPONENT}")
    mantissa, _, divisor = stripped.partition("/")
    try:
        return Fraction(mantissa) / int(divisor or 1)
    except ZeroDivisionError:
        raise InputError(name, text, "division by zero") from None
    except ValueError:  # Python reads no integer of more than 4300 digits
        raise _too_long(name, text) from None


def _too_long(name: str, value: Number) -> InputError:
    return InputError(name, value, f"has more than {_MAX_BITS} bits")


def _is_float(value: object) -> TypeGuard[float]:
    """Return True for a float, Python's or numpy's; numpy is not imported to see it."""
    is_numpy_real = type(value).__module__ == "numpy" and isinstance(value, Real)
    return isinstance(value, float) or (is_numpy_real and not isinstance(value, Integral))


def _from_float(value: float, name: str) -> Fraction:
    shortest = str(value)  # the shortest decimal, of numpy's floats as well
    if not re.search(r"\d", shortest):
        raise InputError(name, value, "not a finite number")
    return Fraction(shortest)


def text(value: Fraction) -> str:
    """Return an exact text of a rational: a decimal if it ends after at most 20 places and
    |value| < 10^20, else a quotient.

    >>> text(Fraction(1, 8)), text(Fraction(1, 3))
    ('0.125', '1/3')
    """
    denominator = value.denominator
    twos = fives = 0
    while denominator % 2 == 0:
        denominator, twos = denominator // 2, twos + 1
    while denominator % 5 == 0:
        denominator, fives = denominator // 5, fives + 1
    places = max(twos, fives)
    if denominator != 1 or places > 20 or abs(value) >= 10**20:
        return str(value)
    digits = f"{abs(value.numerator) * 10**places // value.denominator:0{places + 1}d}"
    sign = "-" if value < 0 else ""
    return sign + (f"{digits[:-places]}.{digits[-places:]}" if places else digits)


def plain(value: Fraction, digits: int) -> str:
    """Return the value with `digits` significant digits, without an exponent if it is 0 or
    10^−3 ≤ |value| < 10^4.

    >>> plain(Fraction(1, 3), 5)
    '0.33333'
    """
    ordinary = value == 0 or _PLAIN_RANGE[0] <= abs(value) < _PLAIN_RANGE[1]
    return f"{float(value):.{digits}g}" if ordinary else decimal(value, digits)


def short(value: Fraction) -> str:
    """Return the exact text if that is short, else three significant digits.

    >>> short(Fraction(1, 3)), short(Fraction(1, 3**30))
    ('1/3', '4.86e-15')
    """
    exact_text = text(value)
    return exact_text if len(exact_text) <= _SHORT_LENGTH else decimal(value, 3)


def quotient(x: Any) -> Any:
    """Return a float, a number of MPFR or a rational as a rational of gmpy2, which compares,
    subtracts and divides some ten times as fast as a Fraction."""
    return gmpy2.mpq(*x.as_integer_ratio())  # mpq(x) would take four times as long


def fraction(x: Any) -> Fraction:
    """Return a rational of gmpy2, or a finite number of MPFR, as the Fraction that equals it."""
    numerator, denominator = x.as_integer_ratio()
    return Fraction(int(numerator), int(denominator))


def of_mpf(x: Mpf) -> Fraction:
    """Return a finite number of mpmath as the Fraction that equals it."""
    sign, mantissa, exponent, _ = x._mpf_
    size = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    return -size if sign else size


def decimal(value: Fraction, digits: int) -> str:
    """Return `value` rounded half-even to `digits` significant digits, in scientific notation.

    >>> decimal(Fraction(1, 3), 4)
    '3.333e-01'
    """
    if value == 0:
        return "0"
    return _format_units(*rounded_units(value, digits), digits)


def _format_units(units: int, exponent: int, digits: int) -> str:
    mantissa = gmpy2.mpz(abs(units)).digits()  # str() stops at 4300 digits
    exponent += len(mantissa) - 1
    mantissa = mantissa[:digits]  # 9.99… rounded up is 10.0…, which has one digit more
    sign = "-" if units < 0 else ""
    point = f".{mantissa[1:]}" if digits > 1 else ""
    return f"{sign}{mantissa[0]}{point}e{exponent:+03d}"


def rounded_units(value: Fraction, digits: int) -> tuple[int, int]:
    """Return (units, exponent): value ≠ 0 is rounded half-even to units·10^exponent.

    `units` has `digits` digits, or one more if it was rounded up to 10^digits.

    >>> rounded_units(Fraction(1, 3), 4)
    (3333, -4)
    """
    exponent = magnitude(value) - digits + 1
    top, bottom = _in_units(value, exponent)
    units, rest = divmod(top, bottom)
    up = 2 * rest > bottom or (2 * rest == bottom and units % 2 == 1)
    return units + up, exponent


def _in_units(value: Fraction, exponent: int) -> tuple[int, int]:
    """Return value/10^exponent as a quotient that is not in lowest terms, which would take long."""
    top, bottom = value.numerator, value.denominator
    return (top * 10**-exponent, bottom) if exponent < 0 else (top, bottom * 10**exponent)


def magnitude(value: Fraction) -> int:
    """Return the decimal exponent e of value ≠ 0: 10^e ≤ |value| < 10^(e+1).

    >>> magnitude(Fraction(1234))
    3
    """
    top, bottom = abs(value.numerator), value.denominator
    # log₁₀ 2 ≈ 30103/100000: the bit lengths give the exponent, or a little less.
    exponent = (top.bit_length() - bottom.bit_length()) * 30103 // 100000 - 1
    if exponent < 0:
        top *= 10**-exponent
    else:
        bottom *= 10**exponent
    while 10 * bottom <= top:
        bottom *= 10
        exponent += 1
    return exponent


def known_digits(value: Fraction, bound: Fraction, most: int) -> tuple[str, str]:
    """Return `value` as a text with the digits that `bound` allows (at most `most`), and a bound on
    the text's error.

    The unit of the last digit is at least twice `bound`, so that this digit is right to one unit.
    The returned bound includes the rounding of the text. If no digit is known, the text is "0".

    >>> known_digits(Fraction(1, 3), Fraction(1, 10**5), 12)
    ('3.333e-01', '4.34e-05')
    """
    digits = _count_known_digits(value, bound, most)
    if not digits:
        return "0", upper(abs(value) + bound)
    units, exponent = rounded_units(value, digits)
    rounding = abs(value - units * Fraction(10) ** exponent)
    return _format_units(units, exponent, digits), upper(bound + rounding)


def known_text(value: Fraction, bound: Fraction, most: int) -> str:
    """Return the text of `known_digits` without its bound.

    >>> known_text(Fraction(1, 3), Fraction(1, 10**5), 12)
    '3.333e-01'
    """
    digits = _count_known_digits(value, bound, most)
    return decimal(value, digits) if digits else "0"


def _count_known_digits(value: Fraction, bound: Fraction, most: int) -> int:
    """Return the number of digits that the bound allows, at most `most`; 0 if no digit is known, or
    the value is 0."""
    if not value:
        return 0
    # The last printed digit must have a unit of at least twice the bound.
    return min(most, max(0, magnitude(value) - magnitude(2 * bound))) if bound else most


def upper(bound: Fraction) -> str:
    """Return a bound as a text, rounded up to three significant digits.

    >>> upper(Fraction(1, 3))
    '3.34e-01'
    """
    if bound == 0:
        return "0"
    exponent = magnitude(bound) - 2
    top, bottom = _in_units(bound, exponent)
    return _format_units(-(-top // bottom), exponent, 3)
