"""Balls by Arb (python-flint): every number is a midpoint with a radius that holds the true value.

A kernel's values therefore enclose those of exact arithmetic at the exact inputs: the rounding of
each operation goes into the radius. Balls do not know that errors are correlated: along an orbit
they widen like e^(cT). Each further bit of precision halves the radii.

A ball need not be as narrow as possible. If an operation is undefined somewhere in a ball (as the
logarithm of a ball that touches 0), the result is NaN, and so is every later result.
"""

from fractions import Fraction
from functools import partial
from typing import Any

from verify.arithmetic.number_system import (
    ESCAPE_BITS,
    Arithmetic,
    NumberSystem,
    bits_for,
    interpret,
)
from verify.functions import in_rings

NAME = "ball"


def make(digits: int) -> Arithmetic:
    """Return balls whose midpoints have the bits for `digits` decimal digits."""
    return at_bits(bits_for(digits))


def at_bits(bits: int) -> Arithmetic:
    import flint

    from verify.arithmetic.arb import midpoint_and_radius, rational_ball
    from verify.arithmetic.flint_precision import working_precision

    context = partial(working_precision, bits)

    def number(value: Fraction) -> Any:
        with context():
            return rational_ball(value)

    def in_range(x: Any) -> bool:
        """Return True if x is in range, and has a digit or a radius below 1. A wider ball says
        nothing of the orbit: more precision helps then."""
        return bool(abs(x) < escape and (x.rel_accuracy_bits() > 0 or x.rad() < 1))

    escape = flint.arb(2) ** ESCAPE_BITS
    with context():
        pi = flint.arb.pi()
    return Arithmetic(
        name=NAME,
        bits=bits,
        number=number,
        exact=lambda x: midpoint_and_radius(x)[0],
        radius=lambda x: midpoint_and_radius(x)[1],
        finite=in_range,
        context=context,
        functions={
            **{name: function.of_balls(flint.arb) for name, function in in_rings().items()},
            **{name: getattr(flint.arb, name) for name in ("sin_cos", "sqrt", "root")},
            "pi": pi,
            "minimum": flint.arb.min,
            "maximum": flint.arb.max,
        },
        compile=interpret,
        # NaN stays NaN, and exponents have no limit: a look at the end of a chunk is enough. The
        # chunk is so short that even a cube at every step makes no exponent that takes long.
        guard=None,
        pipelined=False,
        chunk=1 << 9,
    )


NUMBER_SYSTEM = NumberSystem(
    NAME, make, "midpoints with radii, which enclose every result by themselves", cost=500
)
