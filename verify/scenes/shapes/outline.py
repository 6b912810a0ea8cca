"""Closed outlines in the plane: smooth arcs that join, each s ↦ (x, y) in any arithmetic.

An arc's formula is written once over `mp`, mpmath's context or one that takes arrays of float64
(`verify.arithmetic.float_context`), so that it has as many digits as the area measured with it.

An arc is a Bézier curve, such as a line, or part of an ellipse between two points, as the A command
of SVG paths defines it. SVG computes the centre and two angles (SVG 1.1, appendix F.6.5). Here the
arc is written relative to its chord, as M + 2 N sin αs sin α(1 − s) + E sin α(2s − 1), with M the
middle of the chord, α half the angle, E along the chord and N across it in the frame where the
ellipse is a circle. It is the same arc, but its ends keep their digits however large the radii are.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
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


def _move_arc(arc: Arc, q: Fraction, p: Fraction, scale: Fraction) -> Arc:
    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        x, y = arc(mp, s)
        size = number(mp, scale)
        return number(mp, q) + size * x, number(mp, p) + size * y

    return evaluate


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


@dataclass(frozen=True)
class EllipticalArc:
    """An arc from `start` to `end` on an ellipse of radii > 0, its first axis turned by `degrees`.

    `is_large`: the part longer than half of it; `is_counterclockwise`: with y pointing upwards.
    Where no such ellipse passes through both points, the radii are scaled up until one does.
    """

    start: Point
    end: Point
    radii: Point
    degrees: Fraction
    is_large: bool
    is_counterclockwise: bool


def elliptical_curve(arc: EllipticalArc) -> Arc:
    """Return the arc as a formula; its ends must differ."""
    # The frame depends on the precision alone, and is used for thousands of points.
    frame = cache(lambda bits: _frame(arc, bits))

    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        half, *vectors = frame(mp.prec)
        alpha = mp.mpf(half)
        sideways = 2 * mp.sin(alpha * s) * mp.sin(alpha * (1 - s))
        lengthwise = mp.sin(alpha * (2 * s - 1))
        (mx, my), (nx, ny), (ex, ey) = ([mp.mpf(c) for c in vector] for vector in vectors)
        return mx + nx * sideways + ex * lengthwise, my + ny * sideways + ey * lengthwise

    return evaluate


def _frame(arc: EllipticalArc, bits: int) -> tuple[Number, ...]:
    """Return α and the vectors M, N, E with a few more than so many bits."""
    import mpmath

    mp = mpmath.MPContext()
    # Near half of an ellipse the square root of a small remainder loses half of the digits.
    mp.prec = 2 * bits + 64
    (x0, y0), (x1, y1), (rx, ry) = (
        (number(mp, x), number(mp, y)) for x, y in (arc.start, arc.end, arc.radii)
    )
    turn = number(mp, arc.degrees) / 180
    cos, sin = mp.cospi(turn), mp.sinpi(turn)
    half_x, half_y = (x1 - x0) / 2, (y1 - y0) / 2
    u, v = (cos * half_x + sin * half_y) / rx, (cos * half_y - sin * half_x) / ry
    chord = mp.sqrt(u * u + v * v)  # half of it: the sine of α
    remainder = (1 - chord) * (1 + chord)
    # The ellipse is too small for the chord: it is scaled up until the chord is a diameter.
    if remainder <= 0:
        alpha, scale = mp.pi / 2, chord
    else:
        alpha, scale = mp.atan2(chord, mp.sqrt(remainder)), mp.mpf(1)
        alpha = mp.pi - alpha if arc.is_large else alpha
    u, v = scale * u / chord, scale * v / chord

    def to_plane(a: Number, b: Number) -> tuple[Number, Number]:
        return cos * rx * a - sin * ry * b, sin * rx * a + cos * ry * b

    # Counterclockwise, the arc lies to the right of its chord.
    normal = to_plane(v, -u) if arc.is_counterclockwise else to_plane(-v, u)
    return alpha, ((x0 + x1) / 2, (y0 + y1) / 2), normal, to_plane(u, v)
