"""The numbers that a step of others computes in, and what of it a probe can see."""

from dataclasses import dataclass
from fractions import Fraction

from verify.errors import unknown


@dataclass(frozen=True)
class NumberType:
    """`bits` of the significand. `parts`: doubles that one number is the sum of, or 1.

    `declared`: what C calls it. `digits`: decimals that tell any two of them apart.
    """

    name: str
    bits: int
    declared: str
    digits: int
    parts: int = 1

    @property
    def declared_as(self) -> str:
        """What it is called in a sentence."""
        return self.name if self.parts > 1 else self.declared

    @property
    def epsilon(self) -> float:
        """Between 1 and the next number."""
        return 2.0 ** (1 - self.bits)

    @property
    def width(self) -> float:
        """Of a central difference of the sixth order whose error and rounding are alike."""
        return 2.0 ** -(self.bits // 7)

    def rounded(self, x: Fraction) -> Fraction:
        """The nearest number of the type, but for its range."""
        if self.parts > 1:
            high = Fraction(float(x))
            return high + Fraction(float(x - high))
        if x == 0 or self.bits == DOUBLE_BITS:
            return Fraction(float(x))
        exponent = abs(x.numerator).bit_length() - x.denominator.bit_length()
        unit = Fraction(2) ** (exponent - self.bits)
        while abs(x) >= unit * 2**self.bits:
            unit *= 2
        while abs(x) < unit * 2 ** (self.bits - 1):
            unit /= 2
        return round(x / unit) * unit


DOUBLE_BITS = 53
DOUBLE = NumberType("double", DOUBLE_BITS, "double", 17)
LONG_DOUBLE = NumberType("long-double", 64, "long double", 21)
FLOAT128 = NumberType("float128", 113, "__float128", 36)
DOUBLE_DOUBLE = NumberType("double-double", 106, "double", 33, parts=2)
TYPES = {each.name: each for each in (DOUBLE, LONG_DOUBLE, FLOAT128, DOUBLE_DOUBLE)}


def type_of(name: str) -> NumberType:
    """By its name. Raises InputError for one that is not known."""
    if name not in TYPES:
        raise unknown("--type", name, TYPES, aliases={"quad": "float128", "binary128": "float128"})
    return TYPES[name]
