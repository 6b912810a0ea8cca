"""A cat's face, around (0, 0) and of radius about 1; every outline is one analytic curve.

The head is an ellipse stretched at the ears by exp(k (cos(θ − θ₀) − 1)), a bump of width 1/√k; the
other outlines are ellipses, bent or stretched to three rounded corners. All have a spectrum that
decreases geometrically, so that the trapezoidal rule converges geometrically on them.
"""

from fractions import Fraction

from verify.arithmetic.float_context import Context, Number, number
from verify.scenes.shapes.outline import Arc, Outline, Shape, angle

Point = tuple[str, str]  # x, y as exact decimals


def _head(mp: Context, s: Number) -> tuple[Number, Number]:
    turn = angle(mp, s)
    x = _value(mp, "0.88") * mp.cos(turn)
    y = _value(mp, "0.72") * mp.sin(turn) - _value(mp, "0.13")
    cos, sin = mp.cos(turn / 2), mp.sin(turn / 2)
    # 1 − cos(θ − θ₀) = 2 sin²((θ − θ₀)/2) keeps its digits in float64; the axes θ₀ are (±8, 15)/17
    # of the ears and (±4, −3)/5 of the cheeks, whose halves are rational but for a common root.
    for side, ear, cheek in (
        (1, 5 * sin - 3 * cos, 3 * sin + cos),
        (-1, 3 * sin - 5 * cos, sin + 3 * cos),
    ):
        # A broad bump and a sharper one on it make an ear.
        broad, tip = (mp.exp(-k * ear * ear / 17) for k in (10, 40))
        x += side * (_value(mp, "0.05") * broad + _value(mp, "0.12") * tip)
        y += _value(mp, "0.18") * broad + _value(mp, "0.36") * tip
        x += side * _value(mp, "0.10") * mp.exp(-6 * cheek * cheek / 5)
    return x, y


def _value(mp: Context, decimal: str) -> Number:
    return number(mp, Fraction(decimal))


def _ellipse(centre: Point, radii: Point) -> Arc:
    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        x = _value(mp, centre[0]) + _value(mp, radii[0]) * mp.cos(turn)
        return x, _value(mp, centre[1]) + _value(mp, radii[1]) * mp.sin(turn)

    return evaluate


def _almond(centre: Point, radii: Point, tilt: str) -> Arc:
    """An eye: an ellipse with narrow ends, its right end raised by `tilt`."""

    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        cos, sin = mp.cos(turn), mp.sin(turn)
        narrow = 1 - cos * cos * _value(mp, "0.3")
        x = _value(mp, centre[0]) + _value(mp, radii[0]) * cos
        return x, _value(mp, centre[1]) + _value(mp, radii[1]) * sin * narrow + _value(
            mp, tilt
        ) * cos

    return evaluate


def _triangle(centre: Point, up: Point, aside: Point) -> Arc:
    """Three rounded corners: z = e^iθ + e^−2iθ/4 (simple below 1/2), its axes `aside` and `up`."""

    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        # One corner is at the end of the axis `up`.
        lengthwise = mp.cos(turn) + mp.cos(2 * turn) / 4
        sideways = mp.sin(turn) - mp.sin(2 * turn) / 4
        x = _value(mp, centre[0]) + _value(mp, up[0]) * lengthwise + _value(mp, aside[0]) * sideways
        return x, _value(mp, centre[1]) + _value(mp, up[1]) * lengthwise + _value(
            mp, aside[1]
        ) * sideways

    return evaluate


def _mouth(mp: Context, s: Number) -> tuple[Number, Number]:
    """A thin outline about the graph of a wave: one crest below the nose, half of one each side."""
    turn = angle(mp, s)
    u = mp.cos(turn)
    wave = mp.cos(2 * mp.pi * u) * _value(mp, "0.035") + mp.exp(-20 * u * u) * _value(mp, "0.05")
    return _value(mp, "0.22") * u, wave + _value(mp, "0.008") * mp.sin(turn) - _value(mp, "0.415")


def _whisker(root: Point, tip: Point) -> Arc:
    """A thin outline about a parabola from `root` to `tip`, bent upwards halfway."""
    side = 1 if Fraction(tip[0]) > Fraction(root[0]) else -1

    def evaluate(mp: Context, s: Number) -> tuple[Number, Number]:
        turn = angle(mp, s)
        u = mp.cos(turn)
        (x0, x1), (y0, y1) = ([_value(mp, c) for c in pair] for pair in zip(root, tip, strict=True))
        height = (y0 + y1 + (y1 - y0) * u) / 2 + _value(mp, "0.03") * (1 - u * u)
        # Counterclockwise to either side.
        width = side * _value(mp, "0.007") * mp.sin(turn)
        return (x0 + x1 + (x1 - x0) * u) / 2, height + width

    return evaluate


def _outline(name: str, arc: Arc) -> Outline:
    return Outline(name, (arc,))


SHAPE = Shape(
    "cat",
    (
        _outline("head", _head),
        _outline(
            "left inner ear", _triangle(("-0.515", "0.57"), ("-0.045", "0.17"), ("-0.10", "-0.03"))
        ),
        _outline(
            "right inner ear", _triangle(("0.515", "0.57"), ("0.045", "0.17"), ("-0.10", "0.03"))
        ),
        _outline("left eye", _almond(("-0.34", "0.02"), ("0.19", "0.17"), "-0.03")),
        _outline("right eye", _almond(("0.34", "0.02"), ("0.19", "0.17"), "0.03")),
        _outline("left pupil", _ellipse(("-0.33", "0.02"), ("0.05", "0.13"))),
        _outline("right pupil", _ellipse(("0.33", "0.02"), ("0.05", "0.13"))),
        _outline("nose", _triangle(("0", "-0.23"), ("0", "-0.06"), ("0.075", "0"))),
        _outline("mouth", _mouth),
        _outline("left upper whisker", _whisker(("-0.42", "-0.26"), ("-1.12", "-0.10"))),
        _outline("left middle whisker", _whisker(("-0.42", "-0.33"), ("-1.15", "-0.35"))),
        _outline("left lower whisker", _whisker(("-0.42", "-0.40"), ("-1.08", "-0.60"))),
        _outline("right upper whisker", _whisker(("0.42", "-0.26"), ("1.12", "-0.10"))),
        _outline("right middle whisker", _whisker(("0.42", "-0.33"), ("1.15", "-0.35"))),
        _outline("right lower whisker", _whisker(("0.42", "-0.40"), ("1.08", "-0.60"))),
    ),
)
