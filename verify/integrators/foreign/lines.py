"""Numbers in the lines that are sent to a program and read from it.

`t h p1 … pn q1 … qn` is sent, each as a decimal that is read back to the same number; of a number
that is a sum of two doubles both, high and low. `p1 … pn q1 … qn` comes back, in decimals or in
hexadecimal floats. To our own host of libraries and back the numbers go as they lie in the memory
of a C program, on the machines that we know.
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
_LARGEST_EXPONENT = 20_000
_SHOWN_CHARACTERS = 40  # characters of what a program says
_SIZE = 16  # bytes of a long double, and of a __float128
_BIAS, _TOP = 16383, 0x7FFF  # of the exponent: of 1, and the largest, of what is no number


def line_of(numbers: Sequence[float | Fraction], kind: NumberType) -> str:
    """Format the line that is sent to a program."""
    return " ".join(text for x in numbers for text in _texts(x, kind))


def _texts(x: float | Fraction, kind: NumberType) -> list[str]:
    if kind is DOUBLE:
        return [repr(float(x))]
    x = Fraction(x)
    if kind.parts > 1:
        return [*map(repr, two_doubles(x))]
    return [_decimal(x, kind.digits)]


def _decimal(x: Fraction, digits: int) -> str:
    """Format x with so many significant digits."""
    if x == 0:
        return "0.0"
    decimal = Context(digits).divide(Decimal(x.numerator), Decimal(x.denominator))
    return f"{decimal:.{digits - 1}e}"


def numbers_of(line: str, length: int, kind: NumberType) -> Sequence[float | Fraction]:
    """Parse the line that a program answers: so many numbers of its type, floats where these are
    doubles.

    Raises StepError where it is something else.
    """
    words = line.split()
    if len(words) != length * kind.parts:
        expected = count(length, "number") + (" of two doubles" if kind.parts > 1 else "")
        problem = f"; wanted: {expected}, p' and then q', in a line, and nothing else"
        raise StepError(f"it answers {quote(line)}{problem}")
    if kind is DOUBLE:
        return [_double(word) for word in words]
    if kind.parts == 1:
        return [kind.round_number(number_of(word)) for word in words]
    doubles = [Fraction(_double(word)) for word in words]
    return [high + low for high, low in zip(doubles[::2], doubles[1::2], strict=True)]


def _double(word: str) -> float:
    """Parse the nearest double; quickly where Python reads the word, as it does most."""
    with contextlib.suppress(ValueError, OverflowError):
        x = float.fromhex(word) if "x" in word else float(word)
        if x - x == 0 and word.isascii() and "_" not in word:
            return x
    try:
        return float(number_of(word))
    except OverflowError:
        raise StepError(f"it answers {quote(word)}, which is no number of its type") from None


def number_of(word: str) -> Fraction:
    """Parse one number. Raises StepError for what is none, or is not finite."""
    text = word.lower()
    if _NOT_FINITE.fullmatch(text):
        raise _is_not_finite(word)
    for pattern, base, scale in ((_HEXADECIMAL, 16, 2), (_DECIMAL, 10, 10)):
        match = pattern.fullmatch(text)
        if match and match[2] + match[3]:
            exponent = int(match[4] or 0)
            if len(text) > 200 or abs(exponent) > _LARGEST_EXPONENT:
                raise StepError(f"it answers {quote(word)}, which is no number of its type")
            places = len(match[3]) * (4 if base == 16 else 1)
            size = int(match[2] + match[3], base) * Fraction(scale) ** (exponent - places)
            return -size if match[1] == "-" else size
    raise StepError(f"it answers {quote(word)}, which is no number")


def _is_not_finite(text: str) -> StepError:
    return StepError(f"it answers {quote(text)}, which is not finite")


def quote(output: str | bytes) -> str:
    """Quote what a program prints, in a sentence: cut, and without what a terminal acts on."""
    text = output.decode("utf-8", "replace") if isinstance(output, bytes) else output
    text = "".join(x if x.isprintable() else " " for x in text.strip())
    short = text if len(text) <= _SHOWN_CHARACTERS else text[:_SHOWN_CHARACTERS] + "…"
    return f"“{short}”" if short else "an empty line"


def short_line(line: str) -> str:
    """Shorten the line that is sent to a program, for a sentence."""
    text = " ".join(f"{float(x):g}" for x in line.split())
    return text if len(text) <= 2 * _SHOWN_CHARACTERS else text[: 2 * _SHOWN_CHARACTERS] + "…"


# -- as they lie in memory ------------------------------------------------------------------------


def digits_of(numbers: Sequence[float | Fraction], kind: NumberType) -> str:
    """Format the bytes of the numbers as hexadecimal digits, as they lie in the memory of a C
    program."""
    if kind is DOUBLE:
        return array("d", map(float, numbers)).tobytes().hex()
    fractions = [Fraction(x) for x in numbers]
    if kind.parts > 1:
        return array("d", (y for x in fractions for y in two_doubles(x))).tobytes().hex()
    return b"".join(_pack(x, kind) for x in fractions).hex()


def read_digits(line: str, length: int, kind: NumberType) -> Sequence[float | Fraction]:
    """Parse so many numbers from such digits. Raises StepError for a number that is not finite."""
    raw = bytes.fromhex(line)
    if kind is not DOUBLE and kind.parts == 1:
        return [_unpack(raw[k * _SIZE : (k + 1) * _SIZE], kind) for k in range(length)]
    doubles = array("d", raw)
    for x in doubles:
        if x - x != 0:
            raise _is_not_finite(repr(x))
    if kind is DOUBLE:
        return doubles.tolist()
    return [Fraction(x) + Fraction(y) for x, y in zip(doubles[::2], doubles[1::2], strict=True)]


def _stored_bits(kind: NumberType) -> int:
    """Return how many bits of the significand are stored: only a long double stores its leading
    bit, which is 1."""
    return kind.bits if kind is LONG_DOUBLE else kind.bits - 1


def _pack(x: Fraction, kind: NumberType) -> bytes:
    """Return the bytes of x, rounded to the type; of 0 where it is too small."""
    rounded, stored = kind.round_number(x), _stored_bits(kind)
    size, sign = abs(rounded), int(rounded < 0)
    # After rounding x is a whole number over a power of 2, so that this is ⌊log₂|x|⌋ exactly.
    power = size.numerator.bit_length() - size.denominator.bit_length()  # a power of 2
    whole = int(size / Fraction(2) ** (power - kind.bits + 1))
    if not whole or power <= -_BIAS:
        return bytes(_SIZE)
    top = power + _BIAS | sign << 15
    return (whole & ((1 << stored) - 1) | top << stored).to_bytes(_SIZE, "little")


def _unpack(raw: bytes, kind: NumberType) -> Fraction:
    """Return the number that these bytes encode. Raises StepError where it is not finite."""
    whole, stored = int.from_bytes(raw, "little"), _stored_bits(kind)
    significand, top = whole & ((1 << stored) - 1), whole >> stored & 0xFFFF
    sign, exponent = -1 if top >> 15 else 1, top & _TOP
    if exponent == _TOP:
        nan = significand & ((1 << (kind.bits - 1)) - 1)
        raise _is_not_finite("nan" if nan else "inf" if sign > 0 else "-inf")
    # The leading bit of a normal number is implicit in all types but a long double.
    if exponent and stored < kind.bits:
        significand |= 1 << stored
    return sign * significand * Fraction(2) ** ((exponent or 1) - _BIAS - kind.bits + 1)
