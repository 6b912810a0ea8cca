"""Unevaluated sums of two float64 in lanes, high + low with |low| far below |high|.

Of a product, and of a sum whose first term is the larger one, what is lost is some units of 2^−104
of it. Low may be some units in the last place of high: what takes high alone must allow for that.
"""

from typing import NamedTuple

from llvmlite import ir

from verify.arithmetic.lanes.vectors import fused
from verify.arithmetic.wide.limbs import Value


class Pair(NamedTuple):
    """high + low, a vector of float64 each."""

    high: Value
    low: Value


def exact_sum(b: ir.IRBuilder, x: Value, y: Value) -> Pair:
    """x + y, |x| ≥ |y|: rounded, and what that leaves out."""
    total = b.fadd(x, y)
    return Pair(total, b.fadd(b.fsub(x, total), y))


def plus(b: ir.IRBuilder, x: Value, y: Pair) -> Pair:
    """x + y, |x| ≥ |y|."""
    total = exact_sum(b, x, y.high)
    return Pair(total.high, b.fadd(total.low, y.low))


def times(b: ir.IRBuilder, x: Pair, y: Pair) -> Pair:
    product = b.fmul(x.high, y.high)
    rest = fused(b, x.high, y.high, b.fneg(product))
    return Pair(product, fused(b, x.low, y.high, fused(b, x.high, y.low, rest)))
