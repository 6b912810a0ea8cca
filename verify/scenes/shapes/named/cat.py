"""A cat's face, about (0, 0) and of about radius 1: every outline one smooth (analytic) curve.

The head is an ellipse drawn out at the ears by exp(k (cos(θ − θ₀) − 1)), a bump of width 1/√k; the
other outlines are ellipses, bent or drawn to three rounded corners. So all have a spectrum that
falls geometrically, and the trapezoidal rule converges so on them.
"""

from fractions import Fraction

from verify.arithmetic.float_context import Context, Number, number
from verify.scenes.shapes.outline import Arc, Outline, Shape, angle

Point = tuple[str, str]  # x, y as exact decimals


def _head(mp: Context, s: Number) -> tuple[Number, Number]:
    turn = angle(mp, s)
    x = _of(mp, "0.88") * mp.cos(turn)
    y = _of(mp, "0.72") * mp.sin(turn) - _of(mp, "0.13")
    cos, sin = mp.cos(turn / 2), mp.sin(turn / 2)
    # 1 − cos(θ − θ₀) = 2 sin²((θ − θ₀)/2) keeps its digits in float64; the axes θ₀ are (±8, 15)/17
    # of the ears and (±4, −3)/5 of the cheeks, whose halves are rational but for a common root.
    for side, ear, cheek in (
        (1, 5 * sin - 3 * cos, 3 * sin + cos),
        (-1, 3 * sin - 5 * cos, sin + 3 * cos),
    ):
        # A broad bump and a sharper one on it make an ear.
        broad, tip = (mp.exp(-k * ear * ear / 17) for k in (10, 40))
        x += side * (_of(mp, "0.05") * broad + _of(mp, "0.12") * tip)
        y += _of(mp, "0.18") * broad + _of(mp, "0.36") * tip
        x += side * _of(mp, "0.10") * mp.exp(-6 * cheek * cheek / 5)
    return x, y


def _of(mp: Context, decimal: str) -> Number:
    return number(mp, Fraction(decimal))


def _ellipse(centre: Point, radii: Point) -> Arc:
    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        x = _of(mp, centre[0]) + _of(mp, radii[0]) * mp.cos(turn)
        return x, _of(mp, centre[1]) + _of(mp, radii[1]) * mp.sin(turn)

    return at


def _almond(centre: Point, radii: Point, tilt: str) -> Arc:
    """An eye: an ellipse with narrow ends, its right end raised by `tilt`."""

    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        cos, sin = mp.cos(turn), mp.sin(turn)
        narrow = 1 - cos * cos * _of(mp, "0.3")
        x = _of(mp, centre[0]) + _of(mp, radii[0]) * cos
        return x, _of(mp, centre[1]) + _of(mp, radii[1]) * sin * narrow + _of(mp, tilt) * cos

    return at


def _triangle(centre: Point, up: Point, aside: Point) -> Arc:
    """Three rounded corners: z = e^iθ + e^−2iθ/4 (simple below 1/2), its axes `aside` and `up`."""

    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        # One corner is at the end of the axis `up`.
        along = mp.cos(turn) + mp.cos(2 * turn) / 4
        across = mp.sin(turn) - mp.sin(2 * turn) / 4
        x = _of(mp, centre[0]) + _of(mp, up[0]) * along + _of(mp, aside[0]) * across
        return x, _of(mp, centre[1]) + _of(mp, up[1]) * along + _of(mp, aside[1]) * across

    return at


def _mouth(mp: Context, s: Number) -> tuple[Number, Number]:
    """A thin outline about the graph of a wave: one crest below the nose, half of one each side."""
    turn = angle(mp, s)
    u = mp.cos(turn)
    wave = mp.cos(2 * mp.pi * u) * _of(mp, "0.035") + mp.exp(-20 * u * u) * _of(mp, "0.05")
    return _of(mp, "0.22") * u, wave + _of(mp, "0.008") * mp.sin(turn) - _of(mp, "0.415")


def _whisker(root: Point, tip: Point) -> Arc:
    """A thin outline about a parabola from `root` to `tip`, bent upwards halfway."""
    outwards = 1 if Fraction(tip[0]) > Fraction(root[0]) else -1

    def at(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        u = mp.cos(turn)
        (x0, x1), (y0, y1) = ([_of(mp, c) for c in pair] for pair in zip(root, tip, strict=True))
        bent = (y0 + y1 + (y1 - y0) * u) / 2 + _of(mp, "0.03") * (1 - u * u)
        # Counterclockwise to either side.
        width = outwards * _of(mp, "0.007") * mp.sin(turn)
        return (x0 + x1 + (x1 - x0) * u) / 2, bent + width

    return at


def _one(name: str, arc: Arc) -> Outline:
    return Outline(name, (arc,))


SHAPE = Shape(
    "cat",
    (
        _one("head", _head),
        _one(
            "left inner ear", _triangle(("-0.515", "0.57"), ("-0.045", "0.17"), ("-0.10", "-0.03"))
        ),
        _one("right inner ear", _triangle(("0.515", "0.57"), ("0.045", "0.17"), ("-0.10", "0.03"))),
        _one("left eye", _almond(("-0.34", "0.02"), ("0.19", "0.17"), "-0.03")),
        _one("right eye", _almond(("0.34", "0.02"), ("0.19", "0.17"), "0.03")),
        _one("left pupil", _ellipse(("-0.33", "0.02"), ("0.05", "0.13"))),
        _one("right pupil", _ellipse(("0.33", "0.02"), ("0.05", "0.13"))),
        _one("nose", _triangle(("0", "-0.23"), ("0", "-0.06"), ("0.075", "0"))),
        _one("mouth", _mouth),
        _one("left upper whisker", _whisker(("-0.42", "-0.26"), ("-1.12", "-0.10"))),
        _one("left middle whisker", _whisker(("-0.42", "-0.33"), ("-1.15", "-0.35"))),
        _one("left lower whisker", _whisker(("-0.42", "-0.40"), ("-1.08", "-0.60"))),
        _one("right upper whisker", _whisker(("0.42", "-0.26"), ("1.12", "-0.10"))),
        _one("right middle whisker", _whisker(("0.42", "-0.33"), ("1.15", "-0.35"))),
        _one("right lower whisker", _whisker(("0.42", "-0.40"), ("1.08", "-0.60"))),
    ),
)
