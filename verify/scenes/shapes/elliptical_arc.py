"""An arc of an ellipse between two points, as the A command of SVG's paths gives it.

SVG's way goes by the centre and two angles (SVG 1.1, appendix F.6.5). Here the arc is written about
its chord, as M + 2 N sin αs sin α(1 − s) + E sin α(2s − 1), M the middle of the chord, α half the
angle, E along the chord and N across it in the frame where the ellipse is a circle: the same arc,
whose ends keep their digits however large its radii are.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from verify.arithmetic.float_context import Context, Number, number
from verify.scenes.shapes.outline import Arc, Point


@dataclass(frozen=True)
class EllipticalArc:
    """From `start` to `end` on an ellipse of radii > 0, its first axis turned by `degrees`.

    `large`: the part longer than half of it; `left`: counterclockwise, y pointing upwards. Where no
    such ellipse passes through both points, the radii are scaled up until one does.
    """

    start: Point
    end: Point
    radii: Point
    degrees: Fraction
    large: bool
    left: bool


def elliptical(arc: EllipticalArc) -> Arc:
    """The arc as a formula; its ends must differ."""
    frame = cache(lambda bits: _frame(arc, bits))

    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        half, *vectors = frame(mp.prec)
        alpha = mp.mpf(half)
        across = 2 * mp.sin(alpha * s) * mp.sin(alpha * (1 - s))
        along = mp.sin(alpha * (2 * s - 1))
        (mx, my), (nx, ny), (ex, ey) = ([mp.mpf(c) for c in vector] for vector in vectors)
        return mx + nx * across + ex * along, my + ny * across + ey * along

    return at


def _frame(arc: EllipticalArc, bits: int) -> tuple[Number, ...]:
    """α and the vectors M, N, E, to a few more than so many bits."""
    import mpmath

    mp = mpmath.MPContext()
    # Near half of an ellipse the root of a small rest costs half of the digits.
    mp.prec = 2 * bits + 64
    (x0, y0), (x1, y1), (rx, ry) = (
        (number(mp, x), number(mp, y)) for x, y in (arc.start, arc.end, arc.radii)
    )
    turn = number(mp, arc.degrees) / 180
    cos, sin = mp.cospi(turn), mp.sinpi(turn)
    half_x, half_y = (x1 - x0) / 2, (y1 - y0) / 2
    u, v = (cos * half_x + sin * half_y) / rx, (cos * half_y - sin * half_x) / ry
    chord = mp.sqrt(u * u + v * v)  # half of it: the sine of α
    rest = (1 - chord) * (1 + chord)
    if rest <= 0:
        alpha, scale = mp.pi / 2, chord
    else:
        alpha, scale = mp.atan2(chord, mp.sqrt(rest)), mp.mpf(1)
        alpha = mp.pi - alpha if arc.large else alpha
    u, v = scale * u / chord, scale * v / chord

    def in_the_plane(a: Number, b: Number) -> tuple[Number, Number]:
        return cos * rx * a - sin * ry * b, sin * rx * a + cos * ry * b

    # Counterclockwise, the arc lies to the right of its chord.
    normal = in_the_plane(v, -u) if arc.left else in_the_plane(-v, u)
    return alpha, ((x0 + x1) / 2, (y0 + y1) / 2), normal, in_the_plane(u, v)
