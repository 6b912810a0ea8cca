"""Fractions in lanes: their products and series, the reduction of numbers to them, their tables.

A fraction is an integer multiple of the unit 2^(−52 n), below 1, in n limbs or fewer. A fraction in
m limbs has n − m leading limbs that are zero; its products are shorter. When a fraction is
multiplied, all its limbs are in [0, 2^52).
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.multiply_add import Columns, MultiplyAdd
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.products import LaneNumber, count_of
from verify.arithmetic.lanes.vectors import LANES, LIMB_BITS, shuffle, splat
from verify.arithmetic.wide.limbs import I64, Value, words
from verify.arithmetic.wide.limbs import constant as word
from verify.arithmetic.wide.table_series import arb_integer

_NEGLIGIBLE_UNITS = 16  # smaller terms of a series are left out
_GROUP_SIZE = 4  # words of a table's row that are read at once
_GROUPS = ir.VectorType(I64, _GROUP_SIZE)


def constant(value: int, count: int) -> list[Value]:
    """Return an integer, which may be negative, in `count` limbs."""
    low = [splat((value >> LIMB_BITS * i) % (1 << LIMB_BITS)) for i in range(count - 1)]
    return [*low, splat(value >> LIMB_BITS * (count - 1))]


def settle(b: ir.IRBuilder, limbs: Sequence[Value]) -> list[Value]:
    """Return the same number after its carries have moved; the highest limb has the sign."""
    return vectors.settle(b, vectors.carry(b, limbs))


def add(b: ir.IRBuilder, x: Sequence[Value], y: Sequence[Value]) -> list[Value]:
    """Return x + y limb by limb, x the longer one."""
    return [b.add(u, v) for u, v in zip(x, y, strict=False)] + list(x[len(y) :])


def subtract(b: ir.IRBuilder, x: Sequence[Value], y: Sequence[Value]) -> list[Value]:
    """Return x − y limb by limb, x the longer one."""
    return [b.sub(u, v) for u, v in zip(x, y, strict=False)] + list(x[len(y) :])


def negate(b: ir.IRBuilder, condition: Value, x: Sequence[Value]) -> list[Value]:
    """Return −x where the condition holds, else x."""
    return [b.select(condition, b.sub(splat(0), limb), limb) for limb in x]


class Fractions:
    """Products and series of fractions of `count` limbs."""

    def __init__(self, multiply_add: MultiplyAdd, count: int) -> None:
        self.multiply_add, self.count = multiply_add, count

    def product(self, b: ir.IRBuilder, t: Sequence[Value], x: Sequence[Value]) -> list[Value]:
        """Return t x in as many limbs as x, for t of `count` limbs; carries have not moved.

        The error is below 2 m units for m limbs of x: of the column below the lowest kept one only
        the high halves are added. The result is not negative.
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
        """Return c₀ − c₁ τ + c₂ τ² − … for each series, with t = τ·2^shift; the c are positive and
        decrease fast.

        Terms below 16 units are left out. Each other term is wrong by less than 2 m + 2 units, and
        this error is multiplied by t < 1 in each later step. The series are summed side by side:
        while one waits for a product, the processor works on another.
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
        """Set total to the coefficient − t·total, or leave it empty if both are negligible."""
        scaled = round(coefficient * 2 ** (LIMB_BITS * self.count))
        scaled = min(scaled, 2 ** (LIMB_BITS * self.count) - 1)
        if scaled < _NEGLIGIBLE_UNITS:
            return
        value = constant(scaled, -(-scaled.bit_length() // LIMB_BITS))
        total[:] = subtract(b, value, self.product(b, t, settle(b, total))) if total else value

    def shift_down(self, b: ir.IRBuilder, x: Sequence[Value], shift: int) -> list[Value]:
        """Return x / 2^shift rounded down, 0 < shift < 52; all limbs of x but the highest are in
        [0, 2^52)."""
        add_shifted = self.multiply_add.add_shifted
        low = [
            add_shifted(b, vectors.down(b, u, shift), v, LIMB_BITS - shift) for u, v in pairwise(x)
        ]
        return [*low, vectors.down(b, x[-1], shift)]

    def shift_up(self, b: ir.IRBuilder, x: Sequence[Value], shift: int) -> list[Value]:
        """Return x·2^shift, which must be below 1, 0 < shift < 52; all limbs of x are in
        [0, 2^52)."""
        add_shifted = self.multiply_add.add_shifted
        low = [splat(0), *(vectors.down(b, u, LIMB_BITS - shift) for u in x[:-1])]
        return [add_shifted(b, u, v, shift) for u, v in zip(low, x, strict=True)]


class Reduction:
    """The reduction x = k·step + rest for numbers of one format, with a step below 1.

    The rest is a fraction of `count` limbs with a sign. Its error is below 2 units of
    2^(−52 count): the step has 52 bits more than a fraction, and is multiplied by |k| < 2^28.
    `spare`: the number of a fraction's bits that lie below the last bit of a number.
    """

    def __init__(self, numbers: Numbers, step: Callable[[], flint.arb]) -> None:
        self.numbers, self.count = numbers, count_of(numbers.size)
        self.spare = LIMB_BITS * self.count - numbers.fraction
        with working_precision(numbers.size + 256):
            unit = step()
            self.unit = arb_integer(unit, LIMB_BITS * (self.count + 1))
            # A float64 suffices: k may be off by one, and then the rest is still small.
            self.inverse = float((1 / unit).mid())

    def steps(self, b: ir.IRBuilder, x: LaneNumber) -> Value:
        """Return x / step in float64, with a relative error below 2^−50."""
        return b.fmul(self.numbers.to_double(b, x), vectors.splat_double(self.inverse))

    def rest(self, b: ir.IRBuilder, x: LaneNumber, k: Value) -> list[Value]:
        """Return x − k·step, which is below ½ in size; its highest limb has the sign."""
        below = b.icmp_signed("<", k, splat(0))
        size = b.select(below, b.sub(splat(0), k), k)
        # |k|·step; its lowest limb lies below a fraction's unit. Integers are left out on both
        # sides: the rest is below ½ in size, so it is determined without them.
        multiple = settle(b, self._times(b, constant(self.unit, self.count + 1), size))[1:]
        stretched = self._times(b, self.numbers.settle(b, x), splat(1 << self.spare))
        rest = settle(b, subtract(b, stretched, negate(b, below, multiple)))
        # The low 52 bits of the highest limb count; the highest of these is the sign.
        high = vectors.down(b, vectors.up(b, rest[-1], 64 - LIMB_BITS), 64 - LIMB_BITS)
        return [*rest[:-1], high]

    def _times(self, b: ir.IRBuilder, limbs: Sequence[Value], factor: Value) -> list[Value]:
        """Return the product with one limb in as many limbs, without the carry from the highest."""
        multiply_add = self.numbers.multiply_add
        columns = Columns(multiply_add, 0, len(limbs) - 1)
        multiplier = multiply_add.factor(b, factor)
        for i, limb in enumerate(limbs):
            columns.add(b, multiply_add.factor(b, limb), multiplier, i)
        return list(columns.total(b).values())


def rows_of(values: Sequence[int], count: int) -> ir.Constant:
    """Return a table of fractions of `count` limbs each; 1 becomes the largest fraction below 1."""
    largest = 2 ** (LIMB_BITS * count) - 1
    limbs = [
        (min(v, largest) >> LIMB_BITS * i) % (1 << LIMB_BITS) for v in values for i in range(count)
    ]
    return words([*limbs, *[0] * _GROUP_SIZE])  # a group may reach beyond the last row


class Table:
    """A table of fractions of `count` limbs each, as `rows_of` writes it."""

    def __init__(self, module: ir.Module, name: str, rows: ir.Constant, count: int) -> None:
        self.count = count
        self.rows = ir.GlobalVariable(module, rows.type, name)
        self.rows.linkage, self.rows.global_constant = "internal", True
        self.rows.initializer = rows

    def entries(self, b: ir.IRBuilder, rows: Sequence[Value]) -> list[Value]:
        """Return the limbs of the rows, one row for each lane."""
        first = [b.mul(row, word(self.count, 64)) for row in rows]
        limbs: list[Value] = []
        for start in range(0, self.count, _GROUP_SIZE):
            limbs += _transpose(b, [self._group(b, b.add(at, word(start, 64))) for at in first])
        return limbs[: self.count]

    def _group(self, b: ir.IRBuilder, index: Value) -> Value:
        address = b.gep(self.rows, [word(0, 64), index], inbounds=True)
        return b.load(b.bitcast(address, _GROUPS.as_pointer()), align=8)


def _transpose(b: ir.IRBuilder, groups: Sequence[Value]) -> list[Value]:
    """Return one vector with the first words of all lanes, one with the second words, and so on."""
    rows = groups
    if LANES > _GROUP_SIZE:  # two groups side by side in each vector
        pairs = zip(groups[:_GROUP_SIZE], groups[_GROUP_SIZE:], strict=True)
        rows = [shuffle(b, x, y, range(LANES)) for x, y in pairs]
    halves = range(0, LANES, _GROUP_SIZE)

    def pick(x: Value, y: Value, *places: int) -> Value:
        """Return the words at these places of each half: from x for places below 4, else from y."""
        positions = [
            at + half + (LANES - _GROUP_SIZE) * (at >= _GROUP_SIZE)
            for half in halves
            for at in places
        ]
        return shuffle(b, x, y, positions)

    even, odd = (
        [pick(x, y, *places) for x, y in (rows[:2], rows[2:])]
        for places in ((0, 4, 2, 6), (1, 5, 3, 7))
    )
    low, high = (0, 1, 4, 5), (2, 3, 6, 7)
    return [pick(*pair, *places) for places in (low, high) for pair in (even, odd)]
