"""Conditions on a scheme's coefficients: decided exactly, each with its residual."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol, runtime_checkable

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.exact import known_digits
from verify.prose import Prose
from verify.verdict import Verdict

_PRECISIONS = (128, 512, 2048)


@dataclass(frozen=True)
class Condition:
    """One equation between coefficients; `name` is its text, such as "Σ b_i c_i = 1/2".

    `order`: the power of h that needs it; 0 for a condition of area or symmetry. `residue`: left
    side − right side: "0" if it is exactly 0, else a decimal whose digits are all certain.
    `holds`: True if it holds exactly, False if not; None if that is not decided.
    """

    name: str
    order: int
    residue: str
    holds: bool | None


def condition_of(ring: Ring, name: str, order: int, gap: Poly, digits: int) -> Condition:
    """Return the condition that `gap`, left side − right side, is 0.

    `digits`: the limit of the digits in which a residue is printed.
    """
    gap = ring.reduce(gap)
    zero = ring.decide(gap).zero
    return Condition(name, order, "0" if zero else decimal_of(ring, gap, digits), zero)


def decimal_of(ring: Ring, number: Poly, digits: int) -> str:
    """Return a number in the ring as a decimal of at most `digits` digits, all certain."""
    decimal = "unknown"
    for precision in _PRECISIONS:
        value = enclose(ring, number, {}, precision)
        if value is not None and is_representable(value):
            middle, radius = midpoint_and_radius(value)
            decimal, _ = known_digits(middle, radius, digits)
            # If the decimal lacks digits, the next precision is tried.
            if radius * 10 ** (digits + 1) < abs(middle):
                break
    return decimal


@runtime_checkable
class ByConditions(Protocol):
    """A scheme by coefficients, for every H, or if `separable` for every H = T(p) + V(q)."""

    @property
    def separable(self) -> bool: ...

    @property
    def most_order(self) -> int:
        """The highest order with conditions; `order_conditions` raises InputError beyond it."""
        ...

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Return all conditions for agreement of the map with the exact flow up to h^order.

        They are for every H. If those of orders below r hold and one of order r does not, there is
        an H for which the map does not agree with the flow up to h^r.
        """
        ...

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return conditions that together suffice for det J ≡ 1 for every H."""
        ...


@dataclass(frozen=True)
class NearbyOrder:
    """The highest order of exact coefficients near printed ones, with the evidence for it.

    `explanation`: how near they are, and the residuals of the printed digits. `wrong`: a condition
    of the next order that no coefficients near them satisfy; None if that is not decided. `parts`:
    the nearest exact coefficients, to some 90 digits; empty if not known. `times`: the time of each
    of these parts, None for the right time; empty if all are right.
    """

    order: int
    verdict: Verdict
    explanation: Prose
    wrong: Condition | None
    parts: tuple[tuple[str, Fraction], ...]
    times: tuple[Fraction | None, ...] = ()
