"""Numbers in limbs in radix 2^52, one vector each, whose carries wait until they are needed.

A number's limbs are words with signs, and their sum Σ limbᵢ 2^(52 i) is its value: sums are formed
limb by limb, and carries are left where they are until a product, a sign or 64-bit words are asked
for. Then they move up: all limbs but the highest are in [0, 2^52), the highest has the sign.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.multiply_add import MultiplyAdd
from verify.arithmetic.lanes.vectors import DIGIT, splat
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.size import size_of

_MOST_WEIGHT = 1 << 9  # of sums whose carries have not moved: limbs stay below 2^62


def count_of(width: int) -> int:
    """Return the number of limbs for so many bits, the sign among them."""
    return -(-width // DIGIT)


@dataclass(eq=False)
class Number:
    """Limbs from the lowest, each below `weight`·2^52 in size; `width` bits hold its value.

    `settled` are the limbs once carries have moved, `factors` what is multiplied, and `negative`
    where it is; each is written once, where it is first asked for.
    """

    limbs: list[Value]
    width: int
    weight: int = 1
    settled: list[Value] | None = None
    negative: Value | None = None
    carried: list[Value] = field(default_factory=list)
    factors: list[Value] = field(default_factory=list)


class Carries:
    """Operations on the carries of numbers with so many fraction bits, each written once."""

    def __init__(self, fraction: int, multiply_add: MultiplyAdd) -> None:
        self.fraction, self.size, self.multiply_add = fraction, size_of(fraction), multiply_add

    def carry(self, b: ir.IRBuilder, x: Number) -> list[Value]:
        """Return the limbs after the carries have moved; of all but the highest 52 bits count."""
        if not x.carried:
            x.carried = vectors.carry(b, x.limbs)
        return x.carried

    def factors(self, b: ir.IRBuilder, x: Number) -> list[Value]:
        """Return the limbs as they are multiplied."""
        if not x.factors:
            *low, high = self.carry(b, x)
            factor = self.multiply_add.factor
            x.factors = [*(factor(b, limb) for limb in low), factor(b, high, highest=True)]
        return x.factors

    def settle(self, b: ir.IRBuilder, x: Number) -> list[Value]:
        """Return the limbs, all but the highest in [0, 2^52), the highest with the sign."""
        if x.settled is None:
            x.settled = vectors.settle(b, self.carry(b, x))
        return x.settled

    def negative(self, b: ir.IRBuilder, x: Number) -> Value:
        if x.negative is None:
            x.negative = b.icmp_signed("<", self.carry(b, x)[-1], splat(0))
        return x.negative

    def prepare(self, b: ir.IRBuilder, x: Number) -> None:
        """Write here what may be needed later; what is not needed costs nothing."""
        self.settle(b, x)
        self.factors(b, x)
        self.negative(b, x)

    def from_settled(self, limbs: Sequence[Value], width: int) -> Number:
        """Return a number whose carries have moved."""
        limbs = list(limbs)
        return Number(limbs, width, settled=limbs, carried=limbs)

    def light(self, b: ir.IRBuilder, x: Number) -> Number:
        """Return the same number, its carries moved where it is a sum of many."""
        # Each limb is below weight·2^52 in size; a word overflows at 2^63, so carries must move
        # before sums get that heavy.
        if x.weight < _MOST_WEIGHT:
            return x
        return self.from_settled(self.settle(b, x), x.width)
