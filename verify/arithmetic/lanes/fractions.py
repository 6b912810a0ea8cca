"""Fractions in lanes: their products and series, the reduction of numbers to them, their tables.

A fraction is a whole multiple of 2^−52n below 1, in n limbs or fewer. One of m limbs has n − m
leading limbs that are zero, and products of it are shorter. All of a fraction's limbs are in
[0, 2^52) where it is multiplied.
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
from verify.arithmetic.lanes.vectors import DIGIT, LANES, shuffle, splat
from verify.arithmetic.wide.limbs import I64, Value, words
from verify.arithmetic.wide.limbs import constant as word
from verify.arithmetic.wide.table_series import arb_integer

_NEGLIGIBLE = 16  # units of the last place
_GROUP = 4  # words that are read at once, and then turned to one vector each
_GROUPS = ir.VectorType(I64, _GROUP)


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


def negate(b: ir.IRBuilder, condition: Value, x: Sequence[Value]) -> list[Value]:
    """Return −x where the condition holds, else x."""
    return [b.select(condition, b.sub(splat(0), limb), limb) for limb in x]


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
        """Set total to the coefficient − t·total, or leave it empty if both are negligible."""
        scaled = round(coefficient * 2 ** (DIGIT * self.count))
        scaled = min(scaled, 2 ** (DIGIT * self.count) - 1)
        if scaled < _NEGLIGIBLE:
            return
        value = constant(scaled, -(-scaled.bit_length() // DIGIT))
        total[:] = subtract(b, value, self.product(b, t, settle(b, total))) if total else value

    def shift_down(self, b: ir.IRBuilder, x: Sequence[Value], shift: int) -> list[Value]:
        """Return x / 2^shift rounded down, 0 < shift < 52; limbs but the highest are settled."""
        add_shifted = self.multiply_add.add_shifted
        low = [add_shifted(b, vectors.down(b, u, shift), v, DIGIT - shift) for u, v in pairwise(x)]
        return [*low, vectors.down(b, x[-1], shift)]

    def shift_up(self, b: ir.IRBuilder, x: Sequence[Value], shift: int) -> list[Value]:
        """Return x·2^shift, below 1, 0 < shift < 52; all limbs of x are settled."""
        add_shifted = self.multiply_add.add_shifted
        low = [splat(0), *(vectors.down(b, u, DIGIT - shift) for u in x[:-1])]
        return [add_shifted(b, u, v, shift) for u, v in zip(low, x, strict=True)]


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
            unit = step()
            self.unit = arb_integer(unit, DIGIT * (self.count + 1))
            # A float64 suffices: k may be off by one, and then the rest is still small.
            self.inverse = float((1 / unit).mid())

    def steps(self, b: ir.IRBuilder, x: LaneNumber) -> Value:
        """Return x / step in float64, within 2^−50 of its size."""
        return b.fmul(self.numbers.to_double(b, x), vectors.splat_double(self.inverse))

    def rest(self, b: ir.IRBuilder, x: LaneNumber, k: Value) -> list[Value]:
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
        multiplier = multiply_add.factor(b, factor)
        for i, limb in enumerate(limbs):
            columns.add(b, multiply_add.factor(b, limb), multiplier, i)
        return list(columns.total(b).values())


def rows_of(values: Sequence[int], count: int) -> ir.Constant:
    """Return fractions of `count` limbs, one after the other; 1 becomes the largest fraction
    below it."""
    largest = 2 ** (DIGIT * count) - 1
    limbs = [(min(v, largest) >> DIGIT * i) % (1 << DIGIT) for v in values for i in range(count)]
    return words([*limbs, *[0] * _GROUP])  # a group may reach beyond the last row


class Table:
    """Fractions of `count` limbs, one after the other, as `rows_of` writes them."""

    def __init__(self, module: ir.Module, name: str, rows: ir.Constant, count: int) -> None:
        self.count = count
        self.rows = ir.GlobalVariable(module, rows.type, name)
        self.rows.linkage, self.rows.global_constant = "internal", True
        self.rows.initializer = rows

    def entries(self, b: ir.IRBuilder, rows: Sequence[Value]) -> list[Value]:
        """Return the limbs of the lanes' rows."""
        first = [b.mul(row, word(self.count, 64)) for row in rows]
        limbs: list[Value] = []
        for start in range(0, self.count, _GROUP):
            limbs += _transpose(b, [self._group(b, b.add(at, word(start, 64))) for at in first])
        return limbs[: self.count]

    def _group(self, b: ir.IRBuilder, index: Value) -> Value:
        address = b.gep(self.rows, [word(0, 64), index], inbounds=True)
        return b.load(b.bitcast(address, _GROUPS.as_pointer()), align=8)


def _transpose(b: ir.IRBuilder, groups: Sequence[Value]) -> list[Value]:
    """Return the first words of all lanes, then the second ones, and so on."""
    rows = groups
    if LANES > _GROUP:  # two groups side by side in each vector
        pairs = zip(groups[:_GROUP], groups[_GROUP:], strict=True)
        rows = [shuffle(b, x, y, range(LANES)) for x, y in pairs]
    halves = range(0, LANES, _GROUP)

    def pick(x: Value, y: Value, *places: int) -> Value:
        """Return from each half the words at those places, of the second vector if they are 4
        or more."""
        positions = [
            at + half + (LANES - _GROUP) * (at >= _GROUP) for half in halves for at in places
        ]
        return shuffle(b, x, y, positions)

    even, odd = (
        [pick(x, y, *places) for x, y in (rows[:2], rows[2:])]
        for places in ((0, 4, 2, 6), (1, 5, 3, 7))
    )
    low, high = (0, 1, 4, 5), (2, 3, 6, 7)
    return [pick(*pair, *places) for places in (low, high) for pair in (even, odd)]
