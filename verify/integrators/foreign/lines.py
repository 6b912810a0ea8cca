"""Numbers in the lines that a program is given and gives back.

`t h p1 … pn q1 … qn` goes in, each as a decimal that is read back to the same number; of a number
that is a sum of two doubles both, high and low. `p1 … pn q1 … qn` comes back, in decimals or in
hexadecimal floats. To our own host of libraries and back they go as they lie in the memory of a C
program, on the machines that we know.
"""

import contextlib
import re
from array import array
from collections.abc import Sequence
from decimal import Context, Decimal
from fractions import Fraction

from verify.integrators.user_code.number_type import DOUBLE, LONG_DOUBLE, NumberType, two_doubles
from verify.integrators.user_code.step import StepError
from verify.prose import count

_DECIMAL = re.compile(r"([+-]?)(\d*)\.?(\d*)(?:[eEdDqQ]([+-]?\d+))?", re.ASCII)
_HEXADECIMAL = re.compile(r"([+-]?)0x([0-9a-f]*)\.?([0-9a-f]*)(?:p([+-]?\d+))?", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)(?:\(\w*\))?", re.ASCII)
_LARGEST_EXPONENT = 20_000
_SHOWN = 40  # characters of what a program says
_SIZE = 16  # bytes of a long double, and of a __float128
_BIAS, _TOP = 16383, 0x7FFF  # of the exponent: of 1, and the largest, of what is no number


def line_of(numbers: Sequence[float | Fraction], kind: NumberType) -> str:
    """What a program is given."""
    return " ".join(text for x in numbers for text in _texts(x, kind))


def _texts(x: float | Fraction, kind: NumberType) -> list[str]:
    if kind is DOUBLE:
        return [repr(float(x))]
    x = Fraction(x)
    if kind.parts > 1:
        return [*map(repr, two_doubles(x))]
    return [_decimal(x, kind.digits)]


def _decimal(x: Fraction, digits: int) -> str:
    """With so many significant digits."""
    if x == 0:
        return "0.0"
    rounded = Context(digits).divide(Decimal(x.numerator), Decimal(x.denominator))
    return f"{rounded:.{digits - 1}e}"


def numbers_of(line: str, wanted: int, kind: NumberType) -> Sequence[float | Fraction]:
    """What a program gave back, so many numbers of its type: floats where these are doubles.

    Raises StepError where it is something else.
    """
    words = line.split()
    if len(words) != wanted * kind.parts:
        told = count(wanted, "number") + (" of two doubles" if kind.parts > 1 else "")
        problem = f"; wanted: {told}, p' and then q', in a line, and nothing else"
        raise StepError(f"it answers {quoted(line)}{problem}")
    if kind is DOUBLE:
        return [_double(word) for word in words]
    if kind.parts == 1:
        return [kind.rounded(number_of(word)) for word in words]
    doubles = [Fraction(_double(word)) for word in words]
    return [high + low for high, low in zip(doubles[::2], doubles[1::2], strict=True)]


def _double(word: str) -> float:
    """The nearest double; quickly where Python reads it, as it does most."""
    with contextlib.suppress(ValueError, OverflowError):
        x = float.fromhex(word) if "x" in word else float(word)
        if x - x == 0 and word.isascii() and "_" not in word:
            return x
    try:
        return float(number_of(word))
    except OverflowError:
        raise StepError(f"it answers {quoted(word)}, which is no number of its type") from None


def number_of(word: str) -> Fraction:
    """One number. Raises StepError for what is none, or is not finite."""
    text = word.lower()
    if _NOT_FINITE.fullmatch(text):
        raise _is_not_finite(word)
    for pattern, base, scale in ((_HEXADECIMAL, 16, 2), (_DECIMAL, 10, 10)):
        found = pattern.fullmatch(text)
        if found and found[2] + found[3]:
            exponent = int(found[4] or 0)
            if len(text) > 200 or abs(exponent) > _LARGEST_EXPONENT:
                raise StepError(f"it answers {quoted(word)}, which is no number of its type")
            places = len(found[3]) * (4 if base == 16 else 1)
            size = int(found[2] + found[3], base) * Fraction(scale) ** (exponent - places)
            return -size if found[1] == "-" else size
    raise StepError(f"it answers {quoted(word)}, which is no number")


def _is_not_finite(text: str) -> StepError:
    return StepError(f"it answers {quoted(text)}, which is not finite")


def quoted(said: str | bytes) -> str:
    """What a program says, in a sentence: cut, and without what a terminal acts on."""
    text = said.decode("utf-8", "replace") if isinstance(said, bytes) else said
    text = "".join(x if x.isprintable() else " " for x in text.strip())
    short = text if len(text) <= _SHOWN else text[:_SHOWN] + "…"
    return f"“{short}”" if short else "an empty line"


def short_line(line: str) -> str:
    """What a program is given, in a sentence."""
    text = " ".join(f"{float(x):g}" for x in line.split())
    return text if len(text) <= 2 * _SHOWN else text[: 2 * _SHOWN] + "…"


# -- as they lie in memory ------------------------------------------------------------------------


def digits_of(numbers: Sequence[float | Fraction], kind: NumberType) -> str:
    """Their bytes in hexadecimal digits, as they lie in the memory of a C program."""
    if kind is DOUBLE:
        return array("d", map(float, numbers)).tobytes().hex()
    exact = [Fraction(x) for x in numbers]
    if kind.parts > 1:
        return array("d", (y for x in exact for y in two_doubles(x))).tobytes().hex()
    return b"".join(_packed(x, kind) for x in exact).hex()


def read_digits(line: str, wanted: int, kind: NumberType) -> Sequence[float | Fraction]:
    """The same backwards, so many numbers. Raises StepError for what is not finite."""
    raw = bytes.fromhex(line)
    if kind is not DOUBLE and kind.parts == 1:
        return [_unpacked(raw[k * _SIZE : (k + 1) * _SIZE], kind) for k in range(wanted)]
    doubles = array("d", raw)
    for x in doubles:
        if x - x != 0:
            raise _is_not_finite(repr(x))
    if kind is DOUBLE:
        return doubles.tolist()
    return [Fraction(x) + Fraction(y) for x, y in zip(doubles[::2], doubles[1::2], strict=True)]


def _written(kind: NumberType) -> int:
    """How many bits of the significand are: a long double's first one is, which is 1."""
    return kind.bits if kind is LONG_DOUBLE else kind.bits - 1


def _packed(x: Fraction, kind: NumberType) -> bytes:
    """x, rounded to the type; 0 where it is too small."""
    exact, written = kind.rounded(x), _written(kind)
    size, sign = abs(exact), int(exact < 0)
    power = size.numerator.bit_length() - size.denominator.bit_length()  # a power of 2
    whole = int(size / Fraction(2) ** (power - kind.bits + 1))
    if not whole or power <= -_BIAS:
        return bytes(_SIZE)
    top = power + _BIAS | sign << 15
    return (whole & ((1 << written) - 1) | top << written).to_bytes(_SIZE, "little")


def _unpacked(raw: bytes, kind: NumberType) -> Fraction:
    whole, written = int.from_bytes(raw, "little"), _written(kind)
    significand, top = whole & ((1 << written) - 1), whole >> written & 0xFFFF
    sign, exponent = -1 if top >> 15 else 1, top & _TOP
    if exponent == _TOP:
        nan = significand & ((1 << (kind.bits - 1)) - 1)
        raise _is_not_finite("nan" if nan else "inf" if sign > 0 else "-inf")
    if exponent and written < kind.bits:
        significand |= 1 << written
    return sign * significand * Fraction(2) ** ((exponent or 1) - _BIAS - kind.bits + 1)
