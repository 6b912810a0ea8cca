"""The size of a constant expression, tested before sympy evaluates it.

sympy settles signs and identities of constants by evaluating them, which for sin(exp(exp(100)))
never ends. Ball arithmetic says at once that such a constant is out of reach.
"""

from __future__ import annotations

import math

import flint

from verify.algebra.expressions.functions_used import function_of
from verify.arithmetic.flint_precision import working_precision
from verify.late import sympy

MAX_BITS = 4000


def is_within_reach(constant: sympy.Expr) -> bool:
    """Return True if the constant is finite and below 2^4000 in size, by ball arithmetic."""
    with working_precision(128):
        ball = _ball(constant)
        # 128 bits suffice: only the order of magnitude matters, and a doubtful ball counts as too
        # large.
        limit = flint.arb(2) ** MAX_BITS
        return ball is not None and ball.is_finite() and abs(ball) < limit


def _ball(node: sympy.Expr) -> flint.arb | None:
    """Enclose the constant, or return None where this module does not know the expression."""
    if node.is_Rational:
        return flint.arb(flint.fmpq(int(node.p), int(node.q)))
    if node is sympy.pi:
        return flint.arb.pi()
    if node is sympy.E:
        return flint.arb(1).exp()
    balls = [_ball(argument) for argument in node.args]
    arguments = [x for x in balls if x is not None and x.is_finite()]
    if len(arguments) < len(balls):
        return None
    if node.is_Add:
        return sum(arguments, flint.arb(0))
    if node.is_Mul:
        return math.prod(arguments, start=flint.arb(1))
    if node.is_Pow:
        return arguments[0] ** arguments[1]
    function = function_of(node)
    return None if function is None else function.of_balls(flint.arb)(arguments[0])
