"""MPFR by gmpy2: floating point of any precision, several times as fast as mpmath.

Every operation and function is rounded to nearest. So at equal precision + − × ÷ agree with mpmath
bit for bit; functions may differ in the last bit, since not all of mpmath's are correctly rounded.
Exponents end near ±2^62.

An undefined operation, or a result outside that range, raises an error when the context is left.
An infinity may have become a number again by then, but MPFR's flags record it. (gmpy2's traps check
the flags after each operation, which makes a kernel slower by a fifth.)
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import lru_cache, partial
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

NAME = "mpfr"


def make(digits: int) -> Arithmetic:
    """Return MPFR with the bits for `digits` decimal digits."""
    return at_bits(bits_for(digits))


@lru_cache(maxsize=64)
def at_bits(bits: int) -> Arithmetic:
    import gmpy2

    from verify.arithmetic.exact import fraction

    # A new gmpy2.context for each use: one that is entered twice forgets which to restore.
    new_context = partial(
        gmpy2.context,
        precision=bits,
        round=gmpy2.RoundToNearest,
        emin=gmpy2.get_emin_min(),
        emax=gmpy2.get_emax_max(),
    )

    rounding_context = new_context()

    def number(value: Fraction) -> Any:
        # Rounded once. context.div of gmpy2 2.2 would round to the bits of the caller's context.
        return gmpy2.mpfr(gmpy2.mpq(value), bits, rounding_context)

    with new_context():
        pi = gmpy2.const_pi()
    return Arithmetic(
        name=NAME,
        bits=bits,
        number=number,
        exact=fraction,
        finite=lambda x: gmpy2.is_finite(x) and abs(gmpy2.get_exp(x)) <= MAX_EXPONENT,
        context=partial(_check_flags, new_context),
        functions={
            **{f: getattr(gmpy2, f) for f in (*in_rings(), "sin_cos", "sqrt")},
            "root": _root,
            "approx": float,
            "wide": gmpy2.mpfr,  # exact for a float64: there are at least 53 bits
            "pi": pi,
            "escape": number(Fraction(2**ESCAPE_BITS)),
            "minus_escape": number(Fraction(-(2**ESCAPE_BITS))),
        },
        compile=interpret,
        guard="minus_escape < {x} < escape",
        pipelined=False,
        chunk=1 << 14,
        rounding=relative(bits),
    )


@contextmanager
def _check_flags(new_context: Callable[[], Any]) -> Iterator[None]:
    with new_context() as flags:
        yield
    if flags.invalid or flags.divzero or flags.overflow or flags.underflow:
        raise ArithmeticError("an operation was undefined or left the range of exponents")


def _root(x: Any, n: int) -> Any:
    from gmpy2 import root

    if x < 0:  # MPFR would return the real root for an odd n; here roots of x < 0 are undefined
        raise ValueError("the root of a negative number")
    return root(x, n)


NUMBER_SYSTEM = NumberSystem(
    NAME, make, "floating point of any precision, correctly rounded", cost=700, automatic=True
)
