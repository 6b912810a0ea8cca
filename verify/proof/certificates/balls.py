"""Balls of rational numbers: a middle and a radius, rounded outwards, so that nothing grows long.

A ball holds the number that it stands for. ValueError where a number is beyond all use.
"""

from fractions import Fraction

from verify.proof.certificates.readers import need

Ball = tuple[Fraction, Fraction]  # middle, radius

_BITS = 512  # of a middle
_LARGEST = 256  # argument of sin, cos or exp
_FARTHEST = 1 << 16  # binary exponent of a middle or a radius
_SIGNS = {"sin": (0, 1, 0, -1), "cos": (1, 0, -1, 0), "exp": (1,)}  # of their Taylor series


def plus(x: Ball, y: Ball) -> Ball:
    """x + y."""
    return _rounded(x[0] + y[0], x[1] + y[1])


def times(x: Ball, y: Ball) -> Ball:
    """x·y."""
    return _rounded(x[0] * y[0], abs(x[0]) * y[1] + abs(y[0]) * x[1] + x[1] * y[1])


def function(kind: str, x: Ball) -> Ball:
    """sin, cos or exp of x, or 1/x (`inverse`), which has a value where x is not 0."""
    middle, radius = x
    if kind == "inverse":
        need(abs(middle) > radius, "a denominator may be 0 at the witness")
        return _rounded(1 / middle, radius / (abs(middle) * (abs(middle) - radius)))
    size = abs(middle) + radius
    need(size <= _LARGEST, f"{kind}: its argument is beyond {_LARGEST} at the witness")
    value, error = _taylor(_SIGNS[kind], middle)
    return _rounded(value, error + radius * 3 ** (int(size) + 1))  # the slope is at most e^size


def _taylor(signs: tuple[int, ...], x: Fraction) -> Ball:
    """Σ signs_n xⁿ/n! by Horner's rule on a grid, with a bound of all that is left out.

    What a rounding of half a unit at the n-th term leaves in the sum is |x|ⁿ/n! of it, all together
    e^|x|; terms beyond twice |x| are less than a half of the one before.
    """
    size = int(abs(x)) + 1
    last = 4 * size + 100
    unit = Fraction(1, 1 << (_BITS + 2 * size))
    total = Fraction(0)
    for n in reversed(range(last)):
        total = round((signs[n % len(signs)] + x * total / (n + 1)) / unit) * unit
    left_out = Fraction(2 * size**last)
    for n in range(1, last + 1):
        left_out /= n
    return total, unit * 3**size + left_out


def _rounded(middle: Fraction, radius: Fraction) -> Ball:
    """A ball with a middle of so many bits that holds this one."""
    size = _exponent(middle)
    need(max(abs(size), abs(_exponent(radius))) <= _FARTHEST, "a value is too large or too small")
    unit = Fraction(2) ** (size - _BITS)
    near = round(middle / unit) * unit
    return near, (int((radius + abs(near - middle)) / unit) + 1) * unit


def _exponent(x: Fraction) -> int:
    return x.numerator.bit_length() - x.denominator.bit_length() if x else 0
