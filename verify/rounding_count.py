"""How far a program's value may be from the exact one, anywhere in a box: rounding, counted.

Every operation of a floating-point arithmetic of b bits returns x(1 + δ) for its exact result x on
the arguments that it is given, |δ| ≤ u = 2^(1−b). So an operation's error is what its arguments'
errors become, by the operation's derivative over all values that they can have, and u times its
own size. Both are followed through the program, sizes as intervals by ball arithmetic (Arb), so
that the bound is rigorous: N. J. Higham, Accuracy and Stability of Numerical Algorithms, ch. 2–3.
It takes for granted that functions are rounded as + − × ÷ are, within a unit in the last place:
true of MPFR by its specification, and not promised by mpmath.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import flint

from verify.balls import bounds, rational_ball
from verify.enclosure import BALLS
from verify.number_system import Arithmetic
from verify.program import Op, Program

Ball = Any  # flint.arb
Box = Mapping[str, tuple[Fraction, Fraction]]

ROUNDS_FUNCTIONS = frozenset({"mpfr"})  # rounds sin, exp, … by specification
_BITS = 128  # of the intervals; the bound needs a few digits only
_OPERATIONS = frozenset({"input", "const", "pi", "add", "sub", "mul", "neg", "inverse"})
_SLOPES: dict[str, Callable[[Ball], Ball]] = {
    "sin": lambda x: x.cos(),
    "cos": lambda x: x.sin(),
    "exp": lambda x: x.exp(),
    "sinh": lambda x: x.cosh(),
    "cosh": lambda x: x.sinh(),
    "atan": lambda x: 1 / (1 + _square(x)),
    "log": lambda x: 1 / x,
    "inverse": lambda x: 1 / _square(x),
}


def unit(arithmetic: Arithmetic) -> Fraction:
    """u: one operation's relative error at most, twice that of rounding to nearest."""
    return Fraction(2, 2**arithmetic.bits)


def rounding_error(
    program: Program, root: int, box: Box, arithmetic: Arithmetic
) -> Fraction | None:
    """A bound on |computed − exact| of the program's value `root` for all inputs in the box.

    `box`: the least and the greatest value of each input; the inputs themselves are exact. None
    where there is none: the value is not defined all over the box, or a function's rounding is not
    known.
    """
    needed = _needed(program, root)
    functions = {program.ops[i].kind for i in needed} - _OPERATIONS
    if functions and arithmetic.name not in ROUNDS_FUNCTIONS:
        return None
    with flint.ctx.workprec(_BITS):
        u = rational_ball(unit(arithmetic))
        sizes: dict[int, Ball] = {}
        errors: dict[int, Ball] = {}
        for index in needed:
            op = program.ops[index]
            a = [sizes[i] for i in op.args]
            size = _size(op, a, box)
            carried = _carried(op, a, [errors[i] for i in op.args])
            # Where nothing is rounded: an input, a sign, a constant that is a small integer.
            whole = op.kind == "const" and op.value.denominator == 1 and abs(op.value) < 2**53
            rounded = 0 if op.kind in ("input", "neg") or whole else u * (abs(size) + carried)
            sizes[index], errors[index] = size, flint.arb((carried + rounded).upper())
            if not (size.is_finite() and errors[index].is_finite()):
                return None
        return bounds(errors[root])[1]


def _needed(program: Program, root: int) -> list[int]:
    live, stack = {root}, [root]
    while stack:
        new = set(program.ops[stack.pop()].args) - live
        live |= new
        stack += new
    return sorted(live)


def _size(op: Op, a: list[Ball], box: Box) -> Ball:
    """An interval that holds the operation's exact value all over the box."""
    match op.kind:
        case "input":
            low, high = (rational_ball(x) for x in box[op.name])
            return low.union(high)
        case "const":
            return rational_ball(op.value)
        case "pi":
            return flint.arb.pi()
        case "add":
            return a[0] + a[1]
        case "sub":
            return a[0] - a[1]
        case "mul":
            return _square(a[0]) if op.args[0] == op.args[1] else a[0] * a[1]
        case "neg":
            return -a[0]
    return BALLS[op.kind](a[0], op.degree)


def _carried(op: Op, a: list[Ball], e: list[Ball]) -> Ball:
    """What the arguments' errors e become in the operation's value."""
    match op.kind:
        case "input" | "const" | "pi":
            return flint.arb(0)
        case "add" | "sub":
            return e[0] + e[1]
        case "mul":
            return abs(a[0]) * e[1] + abs(a[1]) * e[0] + e[0] * e[1]
        case "neg":
            return e[0]
    near = a[0] + flint.arb(0, 1) * e[0]  # the argument as it was computed
    if op.kind == "root":
        # d x^(1/n) = x^(1/n) / (n x), positive arguments only
        return abs(near.root(op.degree) / (op.degree * near)) * e[0]
    return abs(_SLOPES[op.kind](near)) * e[0]


def _square(x: Ball) -> Ball:
    """x² without the negative half that a product of two independent x would have."""
    low, high = x.abs_lower(), x.abs_upper()
    return (low * low).union(high * high)
