"""Fixed-point numbers of 128, 156, 192, … bits, compiled by LLVM: for bounded orbits, and fast.

A number has 16 integer bits, the sign among them, and all others after the point: its precision is
absolute. No overflow goes unnoticed: before a run, interval arithmetic finds limits of p and q
within which no operation of a step can leave the format (`verify.kernels.stepping`); the loop ends
when the orbit leaves them, or a function has no value.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

from verify.arithmetic.number_system import Arithmetic, NumberSystem
from verify.arithmetic.wide.size import INTEGER_BITS, WORD, size_of, words_of
from verify.functions import by_name
from verify.functions.function import FixedPoint
from verify.lockstep import Course, meet

if TYPE_CHECKING:
    from verify.arithmetic.arb import Ball

NAME = "fixed"
_THREE_LIMB_BITS = 3 * 52  # this format is in lanes as fast as 128 bits, for one orbit as 192


def make(digits: int) -> Arithmetic:
    """Return the narrowest format that rounds within 10^−digits: to 34, 42, 53, 72, 92, …
    digits."""
    # Half a unit, 2^(−bits − 1), is at most 10^−digits.
    least = size_of(math.ceil(digits * math.log2(10)) - 1)
    width = max(128, WORD * words_of(least))
    return at_bits((_THREE_LIMB_BITS if 128 < least <= _THREE_LIMB_BITS else width) - INTEGER_BITS)


def at_bits(bits: int) -> Arithmetic:
    """Return the format with so many bits after the point, 112 or more."""

    def number(value: Fraction) -> Any:
        from verify.arithmetic.compiled.engine import Fixed

        return Fixed(round(value * 2**bits), bits)

    def compiled_source(source: str, name: str, names: Mapping[str, Any]) -> Callable[..., Any]:
        from verify.arithmetic.compiled.engine import compile_source

        return compile_source(source, bits, names)

    # Fixed point: the error of an operation does not depend on the number's size, except through
    # the functions' own units.
    def rounding(kind: str, degree: int, size: "Ball") -> "Ball":
        # Fixed point has no roots but the square root: others occur only of constants, and are
        # then constants, rounded like π.
        if kind == "root":
            kind = "sqrt" if degree == 2 else "pi"
        return type(size)(2) ** -bits * _units()[kind](size)

    with_pi = {f: f for f in functions()} | {"approx": "approx", "pi": number(_pi(bits))}
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
        rounding=rounding,
        walk=_walk,
    )


NUMBER_SYSTEM = NumberSystem(
    NAME,
    make,
    "fixed-point numbers of 128 bits and more, compiled for this one map",
    cost=40,
    compiles=True,
    most_digits=1000,  # the time of compilation grows, too
    automatic=True,
    in_lanes=True,
)


def functions() -> tuple[str, ...]:
    """Return the names of the functions that exist in fixed point."""
    return (*(name for name, f in by_name().items() if f.fixed is not None), "cos_sin")


@cache
def _units() -> dict[str, Callable[["Ball"], "Ball"]]:
    """Return for each operation the function from the size of its result to a bound on its error,
    in units of the last place.

    See `verify.arithmetic.wide.table_series`.
    """
    from flint import arb

    return {
        "add": lambda _: arb(0), "sub": lambda _: arb(0), "neg": lambda _: arb(0),
        "pi": lambda _: arb("0.501"), "mul": lambda _: arb("0.501"),
        "inverse": lambda y: arb("0.51") * (1 + y),  # the iteration's last step: y + y (1 − x y)
        **{name: _units_of(f.fixed) for name, f in by_name().items() if f.fixed is not None},
    }  # fmt: skip


def _units_of(fixed: FixedPoint) -> Callable[["Ball"], "Ball"]:
    from flint import arb

    return lambda y: arb(fixed.units) + y / fixed.share if fixed.share else arb(fixed.units)


def _walk(
    kernel: Any,
    every: int,
    stops: int,
    fixed: Sequence[Any],
    state: Sequence[Any],
    later_steps: int,
) -> Course[Any]:
    """Make the steps of `Arithmetic.states` in one request; with other orbits' requests to the
    same kernel they are made in lanes."""
    from verify.arithmetic.compiled.engine import Walk

    try:
        return (yield from meet(kernel, Walk(every, stops, fixed, state, later_steps)))
    except OverflowError:  # a number is outside the format from the start
        return []


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
