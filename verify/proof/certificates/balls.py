"""Balls of rational numbers: a midpoint and a radius, rounded outwards to a bounded length.

A result contains all values on its balls. ValueError if a number is too large or too small.
"""

from fractions import Fraction

from verify.proof.certificates.readers import need

Ball = tuple[Fraction, Fraction]  # midpoint, radius

_MIDPOINT_BITS = 512
_MAX_ARGUMENT = 256  # limit for arguments of sin, cos and exp
_MAX_SCALE = 1 << 16  # limit for binary exponents of midpoints and radii, in size
_TAYLOR_SIGNS = {"sin": (0, 1, 0, -1), "cos": (1, 0, -1, 0), "exp": (1,)}  # signs or 0


def plus(x: Ball, y: Ball) -> Ball:
    """Return a ball that contains x + y."""
    return _round_out(x[0] + y[0], x[1] + y[1])


def times(x: Ball, y: Ball) -> Ball:
    """Return a ball that contains x·y."""
    return _round_out(x[0] * y[0], abs(x[0]) * y[1] + abs(y[0]) * x[1] + x[1] * y[1])


def function(kind: str, x: Ball) -> Ball:
    """Enclose sin, cos or exp of x, or 1/x (`inverse`); ValueError if x may be 0."""
    midpoint, radius = x
    if kind == "inverse":
        need(abs(midpoint) > radius, "a denominator may be 0 at the witness")
        return _round_out(1 / midpoint, radius / (abs(midpoint) * (abs(midpoint) - radius)))
    size = abs(midpoint) + radius
    need(size <= _MAX_ARGUMENT, f"{kind}: its argument is beyond {_MAX_ARGUMENT} at the witness")
    value, error = _taylor(_TAYLOR_SIGNS[kind], midpoint)
    return _round_out(value, error + radius * 3 ** (int(size) + 1))  # the slope is at most e^size


def _taylor(signs: tuple[int, ...], x: Fraction) -> Ball:
    """Enclose Σ signs_n xⁿ/n!, computed by Horner's rule on a grid.

    A rounding error of half a unit at the n-th term contributes |x|ⁿ/n! times itself to the sum,
    and all rounding errors together at most e^|x| times half a unit. Beyond n = 2|x| each term is
    less than half of the one before it, so that the truncated tail is at most twice its first term.
    """
    size = int(abs(x)) + 1
    last = 4 * size + 100
    unit = Fraction(1, 1 << (_MIDPOINT_BITS + 2 * size))
    total = Fraction(0)
    for n in reversed(range(last)):
        total = round((signs[n % len(signs)] + x * total / (n + 1)) / unit) * unit
    left_out = Fraction(2 * size**last)
    for n in range(1, last + 1):
        left_out /= n
    return total, unit * 3**size + left_out


def _round_out(midpoint: Fraction, radius: Fraction) -> Ball:
    """Return a ball that contains this one, with a midpoint of a bounded number of bits."""
    # The midpoint keeps _MIDPOINT_BITS bits; its rounding error is added to the radius, which is
    # rounded up to a whole unit.
    size = _exponent(midpoint)
    need(max(abs(size), abs(_exponent(radius))) <= _MAX_SCALE, "a value is too large or too small")
    unit = Fraction(2) ** (size - _MIDPOINT_BITS)
    near = round(midpoint / unit) * unit
    return near, (int((radius + abs(near - midpoint)) / unit) + 1) * unit


def _exponent(x: Fraction) -> int:
    return x.numerator.bit_length() - x.denominator.bit_length() if x else 0
