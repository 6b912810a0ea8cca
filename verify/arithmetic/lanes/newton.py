"""1/x and √x of numbers in lanes, by the steps of one orbit's functions.

`verify.arithmetic.wide.newton` iterates with sums and rounded products of numbers, from a guess in
float64. Each of these operations has the same bits in lanes, so that what is made of them has.
"""

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.vectors import splat_double
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.newton import LEAST_DIVISOR, LEAST_ROOT, iterations


class Newton:
    """1/x and √x for numbers of one format: (where there is a value, the number)."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers, self.fraction = module, numbers, numbers.fraction

    def inverse(self, b: ir.IRBuilder, x: Number) -> tuple[Value, Number]:
        """y ← y + y (1 − x y)."""
        numbers, one = self.numbers, splat_double(1.0)
        size = numbers.known(numbers.settle(b, numbers.absolute(b, x)), numbers.size)
        valid = self._at_least(b, size, LEAST_DIVISOR)
        guess = b.fdiv(one, b.select(valid, numbers.to_double(b, x), one))
        y = numbers.from_double(b, guess)
        unit = numbers.constant(1 << self.fraction, numbers.size)
        for _ in range(iterations(self.fraction, quadratic=True)):
            error = numbers.sub(b, unit, numbers.product(b, x, y))
            y = numbers.add(b, y, numbers.product(b, y, error))
        return valid, y

    def sqrt(self, b: ir.IRBuilder, x: Number) -> tuple[Value, Number]:
        """s ← s + (x − s²)/(2 s₀)."""
        numbers = self.numbers
        valid = self._at_least(b, x, LEAST_ROOT)
        inside = b.select(valid, numbers.to_double(b, x), splat_double(1.0))
        guess = b.call(vectors.intrinsic(self.module, "sqrt"), [inside])
        s = numbers.from_double(b, guess)
        slope = numbers.from_double(b, b.fdiv(splat_double(0.5), guess))
        for _ in range(iterations(self.fraction, quadratic=False)):
            rest = numbers.sub(b, x, numbers.product(b, s, s))
            s = numbers.add(b, s, numbers.product(b, rest, slope))
        return valid, s

    def _at_least(self, b: ir.IRBuilder, x: Number, places: int) -> Value:
        """Where x ≥ 2^−places."""
        least = self.numbers.constant(1 << self.fraction - places, self.numbers.size)
        return b.not_(self.numbers.less(b, x, least))
