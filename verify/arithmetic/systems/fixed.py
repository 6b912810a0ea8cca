"""Fixed-point numbers of 128, 192, 256, … bits, compiled by LLVM: for bounded orbits, and fast.

A number has 16 integer bits, the sign among them, and all others after the point: its precision is
absolute. Nothing overflows unseen: before a run, interval arithmetic finds limits of p and q within
which no operation of a step can leave the format (`verify.kernels.reach`), and the loop ends where
the orbit leaves them, or a function has no value.
"""

import math
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from fractions import Fraction
from typing import Any

from verify.arithmetic.number_system import Arithmetic

NAME = "fixed"
INTEGER_BITS = 16
FUNCTIONS = ("sin", "cos", "cos_sin", "exp", "log", "sqrt", "sinh", "cosh")


def make(digits: int) -> Arithmetic:
    """The narrowest format that rounds within 10^−digits: to 34, 53, 72, 92, … digits."""
    # Half a unit, 2^(−bits − 1), is at most 10^−digits.
    least = math.ceil(digits * math.log2(10)) - 1 + INTEGER_BITS
    return at_bits(max(128, 64 * -(-least // 64)) - INTEGER_BITS)


def at_bits(bits: int) -> Arithmetic:
    """The format with so many bits after the point; with 16 more they must fill whole limbs."""
    width = bits + INTEGER_BITS

    def number(value: Fraction) -> Any:
        from verify.arithmetic.wide.engine import Fixed

        return Fixed(round(value * 2**bits), bits)

    def compiled_source(source: str, name: str, names: Mapping[str, Any]) -> Callable[..., Any]:
        from verify.arithmetic.wide.engine import compiled

        return compiled(source, width, bits, names)

    with_pi = {f: f for f in FUNCTIONS} | {"approx": "approx", "pi": number(_pi(bits))}
    return Arithmetic(
        name=NAME,
        bits=bits,
        number=number,
        exact=_exact,
        finite=_finite,
        context=nullcontext,
        functions=with_pi,
        compile=compiled_source,
        guard=None,
        pipelined=False,
        chunk=1 << 19,
        absolute=True,
    )


def _exact(x: Any) -> Fraction:
    return Fraction(x) if isinstance(x, float) else Fraction(x.raw, 1 << x.fraction)


def _finite(x: Any) -> bool:
    return not isinstance(x, float) or abs(x) < float("inf")


def _pi(bits: int) -> Fraction:
    import flint

    from verify.arithmetic.flint_precision import working_precision

    with working_precision(bits + 64):
        mantissa, exponent = flint.arb.pi().mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
