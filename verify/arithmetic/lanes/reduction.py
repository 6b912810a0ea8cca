"""x as a whole multiple of a table's step and a small rest, in lanes."""

from collections.abc import Callable, Sequence

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number, count_of
from verify.arithmetic.lanes.columns import Columns
from verify.arithmetic.lanes.fractions import constant, negate, settle, subtract
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.vectors import DIGIT, splat
from verify.arithmetic.wide.functions import arb_integer
from verify.arithmetic.wide.limbs import Value


class Reduction:
    """x = k·step + rest for numbers of one format, the step below 1.

    The rest is a fraction of `count` limbs with a sign, and within 2 units of 2^−52 count: the step
    has 52 bits more than a fraction, and is multiplied by |k| < 2^28. `spare`: how many of a
    fraction's bits lie below a number's.
    """

    def __init__(self, numbers: Numbers, step: Callable[[], flint.arb]) -> None:
        self.numbers, self.count = numbers, count_of(numbers.size)
        self.spare = DIGIT * self.count - numbers.fraction
        with working_precision(numbers.size + 256):
            exact = step()
            self.unit = arb_integer(exact, DIGIT * (self.count + 1))
            # A float64 suffices: k may be off by one, and then the rest is still small.
            self.inverse = float((1 / exact).mid())

    def steps(self, b: ir.IRBuilder, x: Number) -> Value:
        """Return x / step in float64, within 2^−50 of its size."""
        return b.fmul(self.numbers.to_double(b, x), vectors.splat_double(self.inverse))

    def rest(self, b: ir.IRBuilder, x: Number, k: Value) -> list[Value]:
        """Return x − k·step, which is below ½ in size; its highest limb has the sign."""
        below = b.icmp_signed("<", k, splat(0))
        size = b.select(below, b.sub(splat(0), k), k)
        # |k|·step, whose lowest limb is below a fraction's units. What is above them is whole
        # numbers, which x has as well, so that they need not be known.
        multiple = settle(b, self._times(b, constant(self.unit, self.count + 1), size))[1:]
        stretched = self._times(b, self.numbers.settle(b, x), splat(1 << self.spare))
        rest = settle(b, subtract(b, stretched, negate(b, below, multiple)))
        # Of the highest limb 52 bits count, the highest of them the sign.
        high = vectors.down(b, vectors.up(b, rest[-1], 64 - DIGIT), 64 - DIGIT)
        return [*rest[:-1], high]

    def _times(self, b: ir.IRBuilder, limbs: Sequence[Value], factor: Value) -> list[Value]:
        """Return the limbs of the product with one limb, without what goes beyond the highest."""
        multiply_add = self.numbers.multiply_add
        columns = Columns(multiply_add, 0, len(limbs) - 1)
        by = multiply_add.factor(b, factor)
        for i, limb in enumerate(limbs):
            columns.add(b, multiply_add.factor(b, limb), by, i)
        return list(columns.total(b).values())
