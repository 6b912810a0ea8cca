"""Decimal logarithms of numbers that no float can hold."""

from decimal import Decimal
from fractions import Fraction
from math import inf


def lg(text: str) -> float:
    """Return lg |value| of a decimal or a quotient of any size; −∞ for 0."""
    if "/" in text:
        value = Fraction(text)
        return lg(str(abs(value.numerator))) - lg(str(value.denominator))
    value_ = abs(Decimal(text))
    return float(value_.log10()) if value_ else -inf
