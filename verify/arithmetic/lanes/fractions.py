"""Fractions in lanes: whole multiples of 2^−52n below 1, in n limbs or fewer.

One of m limbs has n − m leading limbs that are zero, and products of it are shorter. All of a
fraction's limbs are in [0, 2^52) where it is multiplied.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.columns import Columns
from verify.arithmetic.lanes.multiply_add import MultiplyAdd
from verify.arithmetic.lanes.vectors import DIGIT, splat
from verify.arithmetic.wide.limbs import Value

_NEGLIGIBLE = 16  # units of the last place


def constant(value: int, count: int) -> list[Value]:
    """Return a number of units, which may have a sign, in so many limbs."""
    low = [splat((value >> DIGIT * i) % (1 << DIGIT)) for i in range(count - 1)]
    return [*low, splat(value >> DIGIT * (count - 1))]


def settle(b: ir.IRBuilder, limbs: Sequence[Value]) -> list[Value]:
    """Return the same number with its carries moved; the highest limb has the sign."""
    return vectors.settle(b, vectors.carry(b, limbs))


def add(b: ir.IRBuilder, x: Sequence[Value], y: Sequence[Value]) -> list[Value]:
    """Return x + y limb by limb, x the longer one."""
    return [b.add(u, v) for u, v in zip(x, y, strict=False)] + list(x[len(y) :])


def subtract(b: ir.IRBuilder, x: Sequence[Value], y: Sequence[Value]) -> list[Value]:
    """Return x − y limb by limb, x the longer one."""
    return [b.sub(u, v) for u, v in zip(x, y, strict=False)] + list(x[len(y) :])


def negate(b: ir.IRBuilder, where: Value, x: Sequence[Value]) -> list[Value]:
    """Return −x where the condition holds, else x."""
    return [b.select(where, b.sub(splat(0), limb), limb) for limb in x]


class Fractions:
    """Products and series of fractions of `count` limbs."""

    def __init__(self, multiply_add: MultiplyAdd, count: int) -> None:
        self.multiply_add, self.count = multiply_add, count

    def product(self, b: ir.IRBuilder, t: Sequence[Value], x: Sequence[Value]) -> list[Value]:
        """Return t x in as many limbs as x, t of `count` limbs; carries have not moved.

        Within 2 m units for m limbs of x, and not negative: of the column below the lowest kept one
        only the high halves are added.
        """
        columns = Columns(self.multiply_add, 0, len(x) - 1)
        u, v = ([self.multiply_add.factor(b, limb) for limb in limbs] for limbs in (t, x))
        for i in range(len(x)):
            for j in range(self.count - 1 - i, self.count):
                columns.add(b, u[j], v[i], i + j - self.count)
        return list(columns.total(b).values())

    def series(
        self, b: ir.IRBuilder, t: Sequence[Value], *series: Sequence[Fraction], shift: int
    ) -> list[list[Value]]:
        """Return c₀ − c₁ τ + c₂ τ² − … of each series, where t = τ·2^shift; the c are positive and
        fall fast.

        Terms below 16 units are left out; what the others lose is below 2 m + 2 units each, and is
        multiplied by t < 1 further on. All go on together, since each waits for its products.
        """
        totals: list[list[Value]] = [[] for _ in series]
        for j in reversed(range(max(map(len, series)))):
            for total, coefficients in zip(totals, series, strict=True):
                if j < len(coefficients):
                    self._next_term(b, t, total, coefficients[j] / Fraction(2) ** (j * shift))
        return [settle(b, total) for total in totals]

    def _next_term(
        self, b: ir.IRBuilder, t: Sequence[Value], total: list[Value], coefficient: Fraction
    ) -> None:
        """Set total to the coefficient − t·total, or leave it empty where both are negligible."""
        scaled = round(coefficient * 2 ** (DIGIT * self.count))
        scaled = min(scaled, 2 ** (DIGIT * self.count) - 1)
        if scaled < _NEGLIGIBLE:
            return
        value = constant(scaled, -(-scaled.bit_length() // DIGIT))
        total[:] = subtract(b, value, self.product(b, t, settle(b, total))) if total else value

    def shift_down(self, b: ir.IRBuilder, x: Sequence[Value], by: int) -> list[Value]:
        """Return x / 2^by rounded down, 0 < by < 52; all limbs of x but the highest are settled."""
        add_shifted = self.multiply_add.add_shifted
        low = [add_shifted(b, vectors.down(b, u, by), v, DIGIT - by) for u, v in pairwise(x)]
        return [*low, vectors.down(b, x[-1], by)]

    def shift_up(self, b: ir.IRBuilder, x: Sequence[Value], by: int) -> list[Value]:
        """Return x·2^by, below 1, 0 < by < 52; all limbs of x are settled."""
        add_shifted = self.multiply_add.add_shifted
        low = [splat(0), *(vectors.down(b, u, DIGIT - by) for u in x[:-1])]
        return [add_shifted(b, u, v, by) for u, v in zip(low, x, strict=True)]
