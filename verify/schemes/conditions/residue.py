"""Conditions on numbers of a ring: decided exactly, with the residual of one that fails."""

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.exact import known_digits
from verify.schemes.conditions.condition import Condition

_PRECISIONS = (128, 512, 2048)


def condition_of(ring: Ring, name: str, order: int, gap: Poly, digits: int) -> Condition:
    """Return the condition that `gap`, left side − right side, is 0; so many digits of it are
    printed."""
    gap = ring.reduce(gap)
    zero = ring.decide(gap).zero
    return Condition(name, order, "0" if zero else decimal_of(ring, gap, digits), zero)


def decimal_of(ring: Ring, number: Poly, digits: int) -> str:
    """Return a number in the ring as a decimal, every digit of which is known."""
    decimal = "unknown"
    for precision in _PRECISIONS:
        value = enclose(ring, number, {}, precision)
        if value is not None and is_representable(value):
            middle, radius = midpoint_and_radius(value)
            decimal, _ = known_digits(middle, radius, digits)
            # The decimal has all its digits; else the precision is raised, up to the last one.
            if radius * 10 ** (digits + 1) < abs(middle):
                break
    return decimal
