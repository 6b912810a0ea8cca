"""Closed outlines in the plane: smooth arcs that join, each s ↦ (x, y) in whatever arithmetic.

An arc's formula is written once over `mp`, mpmath's context or one that takes arrays of float64
(`verify.arithmetic.float_context`), so that it has as many digits as the area measured with it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import comb

from verify.arithmetic.float_context import Context, Number, number

Arc = Callable[[Context, Number], tuple[Number, Number]]
"""(mp, s) ↦ (x, y), smooth on 0 ≤ s ≤ 1; x is drawn to the right (q), y upwards (p)."""

Point = tuple[Fraction, Fraction]
"""x, y."""


@dataclass(frozen=True)
class Outline:
    """A closed curve: its arcs in their order, each beginning where the one before ends.

    Corners are at the ends of arcs only; a smooth closed curve is one arc or more.
    """

    name: str
    arcs: tuple[Arc, ...]

    def placed(self, q: Fraction, p: Fraction, scale: Fraction) -> "Outline":
        """The same curve scaled about (0, 0) and moved there."""
        return Outline(self.name, tuple(_placed(arc, q, p, scale) for arc in self.arcs))


@dataclass(frozen=True)
class Shape:
    """Outlines that belong together; the first bounds the region whose area is reported."""

    name: str
    outlines: tuple[Outline, ...]

    def placed(self, q: Fraction, p: Fraction, scale: Fraction) -> "Shape":
        return Shape(self.name, tuple(each.placed(q, p, scale) for each in self.outlines))


def angle(mp: Context, s: Number) -> Number:
    """Once around, from −π to π: in float64 its rounding is half of that from 0 to 2π."""
    return 2 * mp.pi * (s - mp.mpf(1) / 2)


def bezier(*control: Point) -> Arc:
    """The Bézier curve of these control points; of two, the line between them."""
    degree = len(control) - 1

    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        x = y = mp.mpf(0)
        for k, (a, b) in enumerate(control):
            weight = comb(degree, k) * (1 - s) ** (degree - k) * s**k
            x, y = x + weight * number(mp, a), y + weight * number(mp, b)
        return x, y

    return at


def _placed(arc: Arc, q: Fraction, p: Fraction, scale: Fraction) -> Arc:
    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        x, y = arc(mp, s)
        size = number(mp, scale)
        return number(mp, q) + size * x, number(mp, p) + size * y

    return at
