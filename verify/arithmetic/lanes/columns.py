"""Products of limbs, added up by columns: xᵢ yⱼ stands in column i + j and the one above it."""

from collections.abc import Mapping
from types import MappingProxyType

from llvmlite import ir

from verify.arithmetic.lanes.multiply_add import MultiplyAdd
from verify.arithmetic.wide.limbs import Value


class Columns:
    """Columns from `low` to `top`; their carries have not moved.

    What lies above `top` is left out, and so is what lies below `low`: of a product in the column
    beneath it the higher half is added, rounded down or to the nearest, of others nothing.
    """

    def __init__(
        self,
        multiply_add: MultiplyAdd,
        low: int,
        top: int,
        start: Mapping[int, int] = MappingProxyType({}),
        *,
        exact: bool = False,
    ) -> None:
        """`start`: what is added to a column besides; `exact`: halves are rounded down, so that of
        a single product less than a unit is left out."""
        self.multiply_add, self.low, self.top = multiply_add, low, top
        self.sums = {c: multiply_add.sum(start.get(c, 0)) for c in range(low, top + 1)}
        self._add_half = multiply_add.high if exact else multiply_add.near

    def add(self, b: ir.IRBuilder, x: Value, y: Value, c: int, *, signed: bool = False) -> None:
        """Add the product of two factors, standing in a column; `signed`: one may be negative."""
        # One column below the kept ones: its high half carries into the lowest kept column, and is
        # added; everything further down is less than a unit for each product.
        if c == self.low - 1:
            self._add_half(b, self.sums[self.low], x, y)
        elif self.low <= c <= self.top:
            above = self.sums[c + 1] if c < self.top else None
            self.multiply_add.both(b, self.sums[c], above, x, y, signed=signed)

    def total(self, b: ir.IRBuilder) -> dict[int, Value]:
        return {c: each.total(b) for c, each in self.sums.items()}
