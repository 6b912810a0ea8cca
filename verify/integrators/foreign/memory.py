"""Numbers as they lie in the memory of a C program, on the machines that we know."""

from array import array
from collections.abc import Sequence
from fractions import Fraction

from verify.integrators.user_code.number_type import DOUBLE, LONG_DOUBLE, NumberType, two_doubles
from verify.integrators.user_code.step import StepError

_SIZE = 16  # bytes of a long double, and of a __float128
_BIAS, _TOP = 16383, 0x7FFF  # of the exponent: of 1, and the largest, of what is no number


def digits_of(numbers: Sequence[float | Fraction], kind: NumberType) -> str:
    """Their bytes in hexadecimal digits."""
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
            raise _not_finite(repr(x))
    if kind is DOUBLE:
        return doubles.tolist()
    return [Fraction(x) + Fraction(y) for x, y in zip(doubles[::2], doubles[1::2], strict=True)]


def _not_finite(text: str) -> StepError:
    return StepError(f"it answers “{text}”, which is not finite")


def _written(kind: NumberType) -> int:
    """How many bits of the significand are: a long double's first one is, which is 1."""
    return kind.bits if kind is LONG_DOUBLE else kind.bits - 1


def _packed(x: Fraction, kind: NumberType) -> bytes:
    """x, rounded to the type; 0 where it is too small."""
    size, sign, written = abs(x), int(x < 0), _written(kind)
    power = size.numerator.bit_length() - size.denominator.bit_length()
    if size < Fraction(2) ** power:
        power -= 1
    whole = round(size / Fraction(2) ** (power - kind.bits + 1))
    if whole >> kind.bits:
        whole, power = whole >> 1, power + 1
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
        raise _not_finite("nan" if nan else "inf" if sign > 0 else "-inf")
    if exponent and written < kind.bits:
        significand |= 1 << written
    return sign * significand * Fraction(2) ** ((exponent or 1) - _BIAS - kind.bits + 1)
