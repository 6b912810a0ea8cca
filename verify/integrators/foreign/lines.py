"""Numbers in the lines that are sent to a program and read from it.

A program is sent `t h p1 … pn q1 … qn`: each number as a decimal that reads back to the same
number, and a double-double as two, high and low. It answers `p1 … pn q1 … qn`, in decimals or in
hexadecimal floats. Our own host of libraries is sent, and answers, the bytes of the numbers in the
memory of a C program instead, as hexadecimal digits, on little-endian machines.
"""

import contextlib
import re
from array import array
from collections.abc import Sequence
from decimal import Context, Decimal
from fractions import Fraction

from verify.integrators.user_code.step import StepError
from verify.integrators.user_code.user_map import DOUBLE, LONG_DOUBLE, NumberType, two_doubles
from verify.prose import count

_DECIMAL = re.compile(r"([+-]?)(\d*)\.?(\d*)(?:[eEdDqQ]([+-]?\d+))?", re.ASCII)
_HEXADECIMAL = re.compile(r"([+-]?)0x([0-9a-f]*)\.?([0-9a-f]*)(?:p([+-]?\d+))?", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)(?:\(\w*\))?", re.ASCII)
# A number with a larger exponent would fill the memory as a fraction, and one with more characters
# would take long to parse; no type needs either.
_MAX_EXPONENT = 20_000
_MAX_NUMBER_CHARACTERS = 200
_MAX_SHOWN_CHARACTERS = 40  # of a program's output, in a message
_BYTES_OF_NUMBER = 16  # of a long double and of a __float128, in memory
# The stored exponent of a long double and of a __float128: that of 1, and that of inf and nan.
_EXPONENT_BIAS, _NON_FINITE_EXPONENT = 16383, 0x7FFF
_EXPONENT_BITS = 15


def format_line(numbers: Sequence[float | Fraction], number_type: NumberType) -> str:
    """Format the line that is sent to a program."""
    return " ".join(text for x in numbers for text in _format_words(x, number_type))


def _format_words(x: float | Fraction, number_type: NumberType) -> list[str]:
    if number_type is DOUBLE:
        return [repr(float(x))]
    x = Fraction(x)
    if number_type.parts > 1:
        return [*map(repr, two_doubles(x))]
    return [_format_decimal(x, number_type.digits)]


def _format_decimal(x: Fraction, digits: int) -> str:
    """Format x with that number of significant digits."""
    if x == 0:
        return "0.0"
    decimal = Context(digits).divide(Decimal(x.numerator), Decimal(x.denominator))
    return f"{decimal:.{digits - 1}e}"


def parse_line(line: str, length: int, number_type: NumberType) -> Sequence[float | Fraction]:
    """Parse the answer of a program: `length` numbers of its type, as floats if these are doubles.

    Raises StepError if the line is anything else.
    """
    words = line.split()
    if len(words) != length * number_type.parts:
        expected = count(length, "number") + (" of two doubles" if number_type.parts > 1 else "")
        problem = f"; wanted: {expected}, p' and then q', in a line, and nothing else"
        raise StepError(f"it answers {quote(line)}{problem}")
    if number_type is DOUBLE:
        return [_parse_double(word) for word in words]
    if number_type.parts == 1:
        return [number_type.round_number(parse_number(word)) for word in words]
    doubles = [Fraction(_parse_double(word)) for word in words]
    return [high + low for high, low in zip(doubles[::2], doubles[1::2], strict=True)]


def _parse_double(word: str) -> float:
    """Parse a word as the nearest double."""
    # Python's own conversion is fast and reads most words. It also accepts digits of other scripts
    # and "1_000", which are refused below.
    with contextlib.suppress(ValueError, OverflowError):
        x = float.fromhex(word) if "x" in word else float(word)
        is_finite = x - x == 0
        if is_finite and word.isascii() and "_" not in word:
            return x
    try:
        return float(parse_number(word))
    except OverflowError:
        raise StepError(f"it answers {quote(word)}, which is no number of its type") from None


def parse_number(word: str) -> Fraction:
    """Parse one number exactly.

    Raises StepError if the word is no number, is not finite, is too long, or has too large an
    exponent.
    """
    text = word.lower()
    if _NOT_FINITE.fullmatch(text):
        raise _non_finite_error(word)
    # The digits of a hexadecimal float have the base 16, its exponent is a power of 2.
    for pattern, base, exponent_base in ((_HEXADECIMAL, 16, 2), (_DECIMAL, 10, 10)):
        match = pattern.fullmatch(text)
        # Groups 1 to 4: the sign, the digits before and after the point, the exponent.
        if match and match[2] + match[3]:
            exponent = int(match[4] or 0)
            if len(text) > _MAX_NUMBER_CHARACTERS or abs(exponent) > _MAX_EXPONENT:
                raise StepError(f"it answers {quote(word)}, which is no number of its type")
            shift = len(match[3]) * (4 if base == 16 else 1)
            digits = int(match[2] + match[3], base)
            magnitude = digits * Fraction(exponent_base) ** (exponent - shift)
            return -magnitude if match[1] == "-" else magnitude
    raise StepError(f"it answers {quote(word)}, which is no number")


def _non_finite_error(text: str) -> StepError:
    """Return the error of a number that is not finite."""
    return StepError(f"it answers {quote(text)}, which is not finite")


def quote(output: str | bytes) -> str:
    """Quote the output of a program in a sentence, cut, and without control characters."""
    text = output.decode("utf-8", "replace") if isinstance(output, bytes) else output
    text = "".join(x if x.isprintable() else " " for x in text.strip())
    short = text if len(text) <= _MAX_SHOWN_CHARACTERS else text[:_MAX_SHOWN_CHARACTERS] + "…"
    return f"“{short}”" if short else "an empty line"


def short_line(line: str) -> str:
    """Shorten the line that is sent to a program for a sentence: fewer digits, and cut."""
    text = " ".join(f"{float(x):g}" for x in line.split())
    return (
        text if len(text) <= 2 * _MAX_SHOWN_CHARACTERS else text[: 2 * _MAX_SHOWN_CHARACTERS] + "…"
    )


# -- as they lie in memory ------------------------------------------------------------------------


def format_memory(numbers: Sequence[float | Fraction], number_type: NumberType) -> str:
    """Format the bytes of the numbers in the memory of a C program, as hexadecimal digits."""
    if number_type is DOUBLE:
        return array("d", map(float, numbers)).tobytes().hex()
    fractions = [Fraction(x) for x in numbers]
    if number_type.parts > 1:
        return array("d", (y for x in fractions for y in two_doubles(x))).tobytes().hex()
    return b"".join(_pack(x, number_type) for x in fractions).hex()


def parse_memory(line: str, length: int, number_type: NumberType) -> Sequence[float | Fraction]:
    """Parse the numbers whose bytes these hexadecimal digits are.

    `length`: how many there are, used for types of 16 bytes alone; doubles are as many as the line
    has. Raises StepError if a number is not finite.
    """
    raw = bytes.fromhex(line)
    if number_type is not DOUBLE and number_type.parts == 1:
        return [
            _unpack(raw[k * _BYTES_OF_NUMBER : (k + 1) * _BYTES_OF_NUMBER], number_type)
            for k in range(length)
        ]
    doubles = array("d", raw)
    for x in doubles:
        is_finite = x - x == 0
        if not is_finite:
            raise _non_finite_error(repr(x))
    if number_type is DOUBLE:
        return doubles.tolist()
    return [Fraction(x) + Fraction(y) for x, y in zip(doubles[::2], doubles[1::2], strict=True)]


def _stored_bits(number_type: NumberType) -> int:
    """Return the number of stored bits of the significand.

    Only a long double stores the leading bit, which is always 1 in a normal number.
    """
    return number_type.bits if number_type is LONG_DOUBLE else number_type.bits - 1


def _pack(x: Fraction, number_type: NumberType) -> bytes:
    """Return the bytes of x, rounded to the type.

    A subnormal number is written as 0; |x| must not exceed the range of the type.
    """
    rounded, stored = number_type.round_number(x), _stored_bits(number_type)
    magnitude, sign = abs(rounded), int(rounded < 0)
    # The denominator is a power of 2 after rounding, so that this is ⌊log₂|x|⌋ exactly.
    exponent = magnitude.numerator.bit_length() - magnitude.denominator.bit_length()
    significand = int(magnitude / Fraction(2) ** (exponent - number_type.bits + 1))
    if not significand or exponent <= -_EXPONENT_BIAS:
        return bytes(_BYTES_OF_NUMBER)
    sign_and_exponent = exponent + _EXPONENT_BIAS | sign << _EXPONENT_BITS
    stored_significand = significand & ((1 << stored) - 1)
    whole = stored_significand | sign_and_exponent << stored
    return whole.to_bytes(_BYTES_OF_NUMBER, "little")


def _unpack(raw: bytes, number_type: NumberType) -> Fraction:
    """Return the number that these bytes encode, normal or subnormal.

    Raises StepError if it is not finite.
    """
    whole, stored = int.from_bytes(raw, "little"), _stored_bits(number_type)
    significand, sign_and_exponent = whole & ((1 << stored) - 1), whole >> stored & 0xFFFF
    sign = -1 if sign_and_exponent >> _EXPONENT_BITS else 1
    exponent = sign_and_exponent & _NON_FINITE_EXPONENT
    if exponent == _NON_FINITE_EXPONENT:
        # Below the leading bit, inf has zeros alone.
        is_nan = significand & ((1 << (number_type.bits - 1)) - 1)
        raise _non_finite_error("nan" if is_nan else "inf" if sign > 0 else "-inf")
    # The leading bit of a normal number is implicit in all types but a long double.
    if exponent and stored < number_type.bits:
        significand |= 1 << stored
    # A subnormal number, stored with the exponent 0, has the scale of the exponent 1.
    power = (exponent or 1) - _EXPONENT_BIAS - number_type.bits + 1
    return sign * significand * Fraction(2) ** power
