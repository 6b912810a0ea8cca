"""mpmath at any precision, in a context of its own: the reference number system.

The global `mpmath.mp` is neither used nor changed.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from threading import get_ident
from typing import Any

from verify.arithmetic.number_system import (
    ESCAPE_BITS,
    MAX_EXPONENT,
    Arithmetic,
    NumberSystem,
    bits_for,
    interpret,
    relative,
)
from verify.functions import in_rings

NAME = "mpmath"


def make(digits: int) -> Arithmetic:
    """Return mpmath with the bits for `digits` decimal digits."""
    return at_bits(bits_for(digits))


def at_bits(bits: int) -> Arithmetic:
    # A new context takes 1 ms, so it is cached, but for one thread: mpmath's functions change it
    # while they run.
    return _arithmetic(bits, get_ident())


@lru_cache(maxsize=32)
def _arithmetic(bits: int, _thread: int) -> Arithmetic:
    import gmpy2
    from mpmath import libmp
    from mpmath.ctx_mp import MPContext

    from verify.arithmetic.exact import of_mpf

    context = MPContext()
    context.prec = bits

    def number(value: Fraction) -> Any:
        rounded = libmp.from_rational(value.numerator, value.denominator, bits, "n")
        return context.make_mpf(rounded)

    def real(function: Callable[..., Any]) -> Callable[..., Any]:
        def check_real(*arguments: Any) -> Any:
            value = function(*arguments)
            if not isinstance(value, context.mpf):
                raise ValueError("a complex value")
            return value

        return check_real

    everywhere = [name for name, f in in_rings().items() if f.domain is None]
    inside = [name for name in in_rings() if name not in everywhere]
    return Arithmetic(
        name=NAME,
        bits=bits,
        number=number,
        exact=of_mpf,
        finite=lambda x: bool(context.isfinite(x) and abs(x._mpf_[2] + x._mpf_[3]) <= MAX_EXPONENT),
        # mpmath's roots use gmpy2: a fresh context, so that a user's traps do not raise in them.
        context=gmpy2.context,
        functions={
            **{f: getattr(context, f) for f in everywhere},
            **{f: real(getattr(context, f)) for f in (*inside, "root", "sqrt")},
            "cos_sin": context.cos_sin,
            "approx": float,
            "wide": context.mpf,  # exact for a float64: there are at least 53 bits
            "pi": +context.pi,
        },
        compile=interpret,
        # |x| < 2^ESCAPE_BITS, read from x = mantissa · 2^exponent and the mantissa's bits: a
        # comparison of two numbers takes twenty times as long.
        guard=f"{{x}}._mpf_[2] + {{x}}._mpf_[3] <= {ESCAPE_BITS}",
        pipelined=False,
        chunk=1 << 12,
        rounding=relative(bits, functions=8),  # twice the 4 units that the conformance suite allows
    )


NUMBER_SYSTEM = NumberSystem(NAME, make, "the same in Python, the reference", cost=3000)
