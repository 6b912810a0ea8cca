"""Functions in fixed point that are made of others, in numbers with 64 bits more after the point.

What is lost in those is far below the last place of the result, which is rounded once.
"""

from dataclasses import dataclass

from llvmlite import ir

from verify.arithmetic.wide.functions import Functions
from verify.arithmetic.wide.limbs import Value, constant
from verify.arithmetic.wide.size import INTEGER_BITS, WORD

MORE = WORD  # bits after the point that the finer numbers have


@dataclass
class Number:
    """A finer number, with + and * rounded as in its format."""

    numbers: "FinerNumbers"
    value: Value

    def __add__(self, other: "Number") -> "Number":
        return Number(self.numbers, self.numbers.b.add(self.value, other.value))

    def __mul__(self, other: "Number") -> "Number":
        product = self.numbers.functions.products.product
        return Number(self.numbers, product(self.numbers.b, self.value, other.value))


class FinerNumbers:
    """Finer numbers in which a function is composed: see `verify.functions.function.FixedPoint`.

    `valid`: whether every function that was applied has a value.
    """

    def __init__(self, b: ir.IRBuilder, functions: Functions) -> None:
        self.b, self.functions = b, functions
        self.valid = ir.Constant(ir.IntType(1), 1)

    @property
    def one(self) -> Number:
        return Number(self, constant(1 << self.functions.fraction, self.functions.width))

    def apply(self, name: str, x: Number) -> Number:
        """Apply the function of that name."""
        packed = self.b.call(self.functions.get(name), [x.value])
        self.valid = self.b.and_(self.valid, self.b.extract_value(packed, 1))
        return Number(self, self.b.extract_value(packed, 0))

    def absolute(self, x: Number) -> Number:
        """Return |x|; the least number has no absolute value."""
        size, functions = self.signed(x, x), self.functions
        top = constant(1 << functions.fraction + INTEGER_BITS - 1, functions.width)
        self.valid = self.b.and_(self.valid, self.b.icmp_unsigned("<", size.value, top))
        return size

    def signed(self, size: Number, like: Number) -> Number:
        """Return the number with its sign changed where `like` is negative."""
        negative = self.b.icmp_signed("<", like.value, constant(0, self.functions.width))
        return self.where(negative, Number(self, self.b.neg(size.value)), size)

    def at_least(self, x: Number, least: Number) -> Value:
        """Return the condition x ≥ least."""
        return self.b.icmp_signed(">=", x.value, least.value)

    def where(self, condition: Value, x: Number, other: Number) -> Number:
        """Return x where the condition holds, else the other."""
        return Number(self, self.b.select(condition, x.value, other.value))
