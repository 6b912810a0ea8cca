"""The numbers that a step of others computes in, and what of it a probe can see."""

from dataclasses import dataclass
from fractions import Fraction

import gmpy2

from verify.arithmetic.exact import fraction
from verify.errors import unknown_name


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
        """The name of the type in a sentence."""
        return self.name if self.parts > 1 else self.declared

    @property
    def epsilon(self) -> float:
        """The distance between 1 and the next number."""
        return 2.0 ** (1 - self.bits)

    def round_number(self, x: Fraction) -> Fraction:
        """Return the nearest number of the type, but for its range."""
        if self.parts > 1:
            return sum(map(Fraction, two_doubles(x)), Fraction(0))
        if self is DOUBLE:
            return Fraction(float(x))
        return fraction(gmpy2.mpfr(gmpy2.mpq(x), self.bits))


def two_doubles(x: Fraction) -> tuple[float, float]:
    """Return the nearest double, and that of the rest."""
    # The nearest double, then the nearest one to what is left: their sum has at least 106 bits.
    high = float(x)
    return high, float(x - Fraction(high))


DOUBLE = NumberType("double", 53, "double", 17)
LONG_DOUBLE = NumberType("long-double", 64, "long double", 21)
FLOAT128 = NumberType("float128", 113, "__float128", 36)
DOUBLE_DOUBLE = NumberType("double-double", 106, "double", 33, parts=2)
TYPES = {each.name: each for each in (DOUBLE, LONG_DOUBLE, FLOAT128, DOUBLE_DOUBLE)}


def type_of(name: str) -> NumberType:
    """Return the type of that name. Raises InputError for one that is not known."""
    if name not in TYPES:
        raise unknown_name(
            "--type", name, TYPES, aliases={"quad": "float128", "binary128": "float128"}
        )
    return TYPES[name]
