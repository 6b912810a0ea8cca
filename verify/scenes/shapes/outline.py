"""Closed outlines in the plane: smooth arcs that join, each s ↦ (x, y) in any arithmetic.

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

    def place_at(self, q: Fraction, p: Fraction, scale: Fraction) -> "Outline":
        """Return the curve scaled about (0, 0) and then moved by (q, p)."""
        return Outline(self.name, tuple(_move_arc(arc, q, p, scale) for arc in self.arcs))


@dataclass(frozen=True)
class Shape:
    """Outlines that belong together; the first bounds the region whose area is reported."""

    name: str
    outlines: tuple[Outline, ...]

    def place_at(self, q: Fraction, p: Fraction, scale: Fraction) -> "Shape":
        return Shape(self.name, tuple(each.place_at(q, p, scale) for each in self.outlines))


def angle(mp: Context, s: Number) -> Number:
    """Return an angle from −π to π; in float64 its rounding error is half of that of 0 to 2π."""
    return 2 * mp.pi * (s - mp.mpf(1) / 2)


def bezier(*control: Point) -> Arc:
    """Return the Bézier curve of these control points; of two, the line between them."""
    degree = len(control) - 1

    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        x = y = mp.mpf(0)
        for k, (a, b) in enumerate(control):
            # Bernstein's polynomials, which in float64 have smaller rounding errors than powers of
            # s.
            weight = comb(degree, k) * (1 - s) ** (degree - k) * s**k
            x, y = x + weight * number(mp, a), y + weight * number(mp, b)
        return x, y

    return evaluate


def _move_arc(arc: Arc, q: Fraction, p: Fraction, scale: Fraction) -> Arc:
    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        x, y = arc(mp, s)
        size = number(mp, scale)
        return number(mp, q) + size * x, number(mp, p) + size * y

    return evaluate
