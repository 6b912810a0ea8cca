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
    """One equation between coefficients: `name` says which, e.g. "Σ b_i c_i = 1/2".

    `order`: the power of h that needs it; 0 where it is about area or symmetry. `residue`: left
    side − right side, "0" where it is exactly 0, else a decimal that is known to its last digit.
    `holds`: exactly so; None where that is not decided.
    """

    name: str
    order: int
    residue: str
    holds: bool | None


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


@runtime_checkable
class ByConditions(Protocol):
    """A scheme for every H (`separable`: every H = T(p) + V(q)) that is defined by coefficients."""

    @property
    def separable(self) -> bool: ...

    @property
    def most_order(self) -> int:
        """The highest order of which there are conditions; `order_conditions` raises InputError
        beyond it."""
        ...

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Return all conditions that make the map agree with the exact flow up to h^order, for
        every H.

        Where those of lower orders hold and one of h^r does not, there is an H for which the map
        does not agree with the flow up to h^r.
        """
        ...

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return all conditions that make det J ≡ 1 for every H; they suffice."""
        ...


@dataclass(frozen=True)
class NearbyOrder:
    """The highest order that exact coefficients near printed ones have, with the evidence for it.

    `explanation`: how near they are, and the residuals that the digits leave. `wrong`: a condition
    of the next order that none near them satisfy; None where that is not decided. `parts`: the
    nearest, to some 90 digits; none where they are not known. `times`: those of the nearest, None
    where it is the right one; none where all are.
    """

    order: int
    verdict: Verdict
    explanation: Prose
    wrong: Condition | None
    parts: tuple[tuple[str, Fraction], ...]
    times: tuple[Fraction | None, ...] = ()
