"""Numbers in the lines that a program is given and gives back.

`t h p1 … pn q1 … qn` goes in, each as a decimal that is read back to the same number; of a number
that is a sum of two doubles both, high and low. `p1 … pn q1 … qn` comes back, in decimals or in
hexadecimal floats.
"""

import math
import re
from collections.abc import Sequence
from fractions import Fraction

from verify.integrators.user_code.number_type import DOUBLE_BITS, NumberType
from verify.integrators.user_code.step import StepError
from verify.prose import count

_DECIMAL = re.compile(r"([+-]?)(\d*)\.?(\d*)(?:[eEdDqQ]([+-]?\d+))?", re.ASCII)
_HEXADECIMAL = re.compile(r"([+-]?)0x([0-9a-f]*)\.?([0-9a-f]*)(?:p([+-]?\d+))?", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)(?:\(\w*\))?", re.ASCII)
_LARGEST_EXPONENT = 20_000
_SHOWN = 40  # characters of what a program says


def line_of(numbers: Sequence[Fraction], kind: NumberType) -> str:
    """What a program is given."""
    return " ".join(text for x in numbers for text in _texts(x, kind))


def _texts(x: Fraction, kind: NumberType) -> list[str]:
    if kind.parts > 1:
        high = float(x)
        return [repr(high), repr(float(x - Fraction(high)))]
    return [repr(float(x))] if kind.bits == DOUBLE_BITS else [_decimal(x, kind.digits)]


def _decimal(x: Fraction, digits: int) -> str:
    """With so many significant digits."""
    if x == 0:
        return "0.0"
    size = abs(x)
    exponent = math.floor(math.log10(size.numerator) - math.log10(size.denominator))
    # A logarithm may be rounded to the next whole number.
    while size >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while size < Fraction(10) ** exponent:
        exponent -= 1
    scaled = round(size / Fraction(10) ** (exponent - digits + 1))
    if scaled == 10**digits:
        exponent, scaled = exponent + 1, scaled // 10
    text = str(scaled)
    return f"{'-' if x < 0 else ''}{text[0]}.{text[1:]}e{exponent:+d}"


def numbers_of(line: str, wanted: int, kind: NumberType) -> list[Fraction]:
    """What a program gave back, so many numbers of its type.

    Raises StepError where it is something else.
    """
    words = line.split()
    if len(words) != wanted * kind.parts:
        told = f"{count(wanted, 'number')} of two doubles" if kind.parts > 1 else str(wanted)
        raise StepError(f"it answers {_quoted(line)}; wanted: {told}, p' and then q', in a line")
    found = [number_of(word) for word in words]
    if kind.parts == 1:
        return [kind.rounded(x) for x in found]
    doubles = [Fraction(float(x)) for x in found]
    return [high + low for high, low in zip(doubles[::2], doubles[1::2], strict=True)]


def number_of(word: str) -> Fraction:
    """One number. Raises StepError for what is none, or is not finite."""
    text = word.lower()
    if _NOT_FINITE.fullmatch(text):
        raise StepError(f"it answers {_quoted(word)}, which is not finite")
    for pattern, base, scale in ((_HEXADECIMAL, 16, 2), (_DECIMAL, 10, 10)):
        found = pattern.fullmatch(text)
        if found and found[2] + found[3]:
            exponent = int(found[4] or 0)
            if len(text) > 200 or abs(exponent) > _LARGEST_EXPONENT:
                raise StepError(f"it answers {_quoted(word)}, which is no number of its type")
            places = len(found[3]) * (4 if base == 16 else 1)
            size = int(found[2] + found[3], base) * Fraction(scale) ** (exponent - places)
            return -size if found[1] == "-" else size
    raise StepError(f"it answers {_quoted(word)}, which is no number")


def _quoted(text: str) -> str:
    text = "".join(x if x.isprintable() else "?" for x in text.strip())
    short = text if len(text) <= _SHOWN else text[:_SHOWN] + "…"
    return f"“{short}”" if short else "an empty line"
