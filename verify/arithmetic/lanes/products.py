"""Numbers in lanes, their carries and their products.

A number has limbs in radix 2^52, one vector each. They are words with signs, and their sum
Σ limbᵢ 2^(52 i) is its value: sums are formed limb by limb, and carries are left where they are
until a product, a sign or 64-bit words are asked for. Then they move up: all limbs but the highest
are in [0, 2^52), the highest has the sign.

A product has the bits of `verify.arithmetic.wide.limbs.product`: it is rounded once. If that
saves time its lowest columns are left out, and if they matter in some lane, it is formed anew
from all of them. If factors are words without a sign, the product of x − X 2^52n and
y − Y 2^52n, X and Y 1 if the number is negative, else 0, is formed from x y by taking X y and
Y x away n limbs higher.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.multiply_add import Columns, MultiplyAdd
from verify.arithmetic.lanes.vectors import DIGIT, WORDS, splat
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.size import size_of

_MOST_WEIGHT = 1 << 9  # of sums whose carries have not moved: limbs stay below 2^62
_WEIGHT = 8  # columns are below 1.5·2^58, and at least 4 bits are shifted out of them
_LEAST_BELOW = 16  # bits that are kept below a product's last, so that they seldom leave it unsure
_EXACT = 1  # below that column less than a unit is left out, and what is kept is rounded down
_ABOVE = 1 << 58  # added to columns if words are shifted down without their signs


def count_of(width: int) -> int:
    """Return the number of limbs for so many bits, the sign among them."""
    return -(-width // DIGIT)


@dataclass(eq=False)
class LaneNumber:
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

    def carry(self, b: ir.IRBuilder, x: LaneNumber) -> list[Value]:
        """Return the limbs after the carries have moved; of all but the highest 52 bits count."""
        if not x.carried:
            x.carried = vectors.carry(b, x.limbs)
        return x.carried

    def factors(self, b: ir.IRBuilder, x: LaneNumber) -> list[Value]:
        """Return the limbs as they are multiplied."""
        if not x.factors:
            *low, high = self.carry(b, x)
            factor = self.multiply_add.factor
            x.factors = [*(factor(b, limb) for limb in low), factor(b, high, highest=True)]
        return x.factors

    def settle(self, b: ir.IRBuilder, x: LaneNumber) -> list[Value]:
        """Return the limbs, all but the highest in [0, 2^52), the highest with the sign."""
        if x.settled is None:
            x.settled = vectors.settle(b, self.carry(b, x))
        return x.settled

    def negative(self, b: ir.IRBuilder, x: LaneNumber) -> Value:
        if x.negative is None:
            x.negative = b.icmp_signed("<", self.carry(b, x)[-1], splat(0))
        return x.negative

    def prepare(self, b: ir.IRBuilder, x: LaneNumber) -> None:
        """Write here what may be needed later; what is not needed costs nothing."""
        self.settle(b, x)
        self.factors(b, x)
        self.negative(b, x)

    def from_settled(self, limbs: Sequence[Value], width: int) -> LaneNumber:
        """Return a number whose carries have moved."""
        limbs = list(limbs)
        return LaneNumber(limbs, width, settled=limbs, carried=limbs)

    def light(self, b: ir.IRBuilder, x: LaneNumber) -> LaneNumber:
        """Return the same number, its carries moved if it is a sum of many."""
        # Each limb is below weight·2^52 in size; a word overflows at 2^63, so carries must move
        # before sums get that heavy.
        if x.weight < _MOST_WEIGHT:
            return x
        return self.from_settled(self.settle(b, x), x.width)


class Products(Carries):
    """Products of numbers with so many fraction bits."""

    def __init__(self, fraction: int, multiply_add: MultiplyAdd) -> None:
        super().__init__(fraction, multiply_add)
        self._lowest, self._drop = divmod(fraction, DIGIT)  # the result's column, bits below it
        first = self._lowest if self._drop >= _LEAST_BELOW else self._lowest - 1
        self._first = first if multiply_add.leaves_out else _EXACT
        self._whole: dict[int, ir.Function] = {}

    def product(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> LaneNumber:
        """Return x y / 2^fraction, rounded to the nearest, halves upwards."""
        columns = self._columns(b, x, y, self._first)
        near = self._round(b, columns, x.width)
        if self._first == _EXACT:
            return LaneNumber(near, x.width, _WEIGHT)
        unsure = vectors.any_of(b, self._unsure(b, columns[self._first]))
        before, cold = b.block, b.append_basic_block("unsure")
        after = b.append_basic_block("sure")
        # The weights move the rare block out of the way, so that the common path stays in
        # straight-line code.
        b.cbranch(unsure, cold, after).set_weights([1, 1 << 20])
        b.position_at_end(cold)
        whole = b.call(
            self._whole_product(b.module, x.width), [*self.carry(b, x), *self.carry(b, y)]
        )
        whole_limbs = [b.extract_value(whole, i) for i in range(len(near))]
        b.branch(after)
        b.position_at_end(after)
        limbs = [b.phi(WORDS) for _ in near]
        for limb, *candidates in zip(limbs, near, whole_limbs, strict=True):
            for value, block in zip(candidates, (before, cold), strict=True):
                limb.add_incoming(value, block)
        return LaneNumber(limbs, x.width, _WEIGHT)

    def _unsure(self, b: ir.IRBuilder, column: Value) -> Value:
        """Return the condition that the omitted columns might carry into the result."""
        lost = self._lost(self._first)
        below = self._drop if self._first == self._lowest else DIGIT
        rest = b.and_(b.add(column, splat(lost)), splat((1 << below) - 1))
        return b.icmp_signed("<", rest, splat(2 * lost))

    @staticmethod
    def _lost(first: int) -> int:
        """Return the units of the first column that may be missing: less than one for each
        product in the two columns beneath it, 2·first − 1 of them, and less than one for all
        further below."""
        return 2 * first

    def _whole_product(self, module: ir.Module, width: int) -> ir.Function:
        """Return a function for the product from all columns: apart, since it is hardly ever
        called."""
        if width in self._whole:
            return self._whole[width]
        count = count_of(width)
        result = ir.LiteralStructType([WORDS] * count)
        kind = ir.FunctionType(result, [WORDS] * (2 * count))
        function = ir.Function(module, kind, f"lanes_whole_product_{width}")
        self._whole[width] = function
        function.linkage = "internal"
        function.attributes.add("noinline")
        b = ir.IRBuilder(function.append_basic_block("entry"))
        x, y = (
            self.from_settled(vectors.settle(b, limbs), width)
            for limbs in (function.args[:count], function.args[count:])
        )
        packed = ir.Constant(result, ir.Undefined)
        for i, limb in enumerate(self._round(b, self._columns(b, x, y, _EXACT), width)):
            packed = b.insert_value(packed, limb, i)
        b.ret(packed)
        return function

    def _columns(
        self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber, first: int
    ) -> dict[int, Value]:
        """Return Σ xᵢ yⱼ and half a unit of the result's last place by columns, from the first on.

        Of the column above the result's highest limb the low bits are needed, or none: not if
        the highest column has room for the sign, and for carries that are still to come.
        """
        top, count = (self.fraction + x.width) // DIGIT, len(x.limbs)
        start = self._start(first, top)
        start[self._lowest] += 1 << (self._drop - 1)
        columns = Columns(self.multiply_add, first, top, start, exact=first == _EXACT)
        u, v = self.factors(b, x), self.factors(b, y)
        if x is not y:
            self._take_signs(b, columns, x, y)
            self._take_signs(b, columns, y, x)
            for i in range(count):
                for j in range(count):
                    columns.add(b, u[i], v[j], i + j, signed=count - 1 in (i, j))
            return columns.total(b)
        mixed = Columns(self.multiply_add, first, top, exact=first == _EXACT)
        self._take_signs(b, mixed, x, x)
        for i in range(count):
            for j in range(i + 1, count):
                mixed.add(b, u[i], u[j], i + j, signed=j == count - 1)
        # A square: the mixed products xᵢ xⱼ, i < j, are formed once and doubled.
        for c, value in mixed.total(b).items():
            columns.sums[c].add(b, b.add(value, value))
        for i in range(count):
            columns.add(b, u[i], u[i], 2 * i, signed=i == count - 1)
        return columns.total(b)

    def _start(self, first: int, top: int) -> dict[int, int]:
        """Return numbers to add to columns so that all but the highest are not negative; their
        sum is 0."""
        above = 0 if vectors.SHIFTS_SIGNS else _ABOVE
        start = dict.fromkeys(range(first, top + 1), 0)
        for c in range(first, top):
            start[c] += above
            start[c + 1] -= above >> DIGIT
        return start

    def _take_signs(self, b: ir.IRBuilder, columns: Columns, x: LaneNumber, y: LaneNumber) -> None:
        """Subtract y, as many columns higher as x has limbs, where x is negative and its factors
        are unsigned."""
        if self.multiply_add.signed:
            return
        for j, limb in enumerate(self.settle(b, y)):
            total = columns.sums.get(len(x.limbs) + j)
            if total is not None:
                reduced = b.sub(total.vector, limb)
                total.vector = b.select(self.negative(b, x), reduced, total.vector)

    def _round(self, b: ir.IRBuilder, columns: Mapping[int, Value], width: int) -> list[Value]:
        """Return the result's limbs, from the columns beginning with the first known one."""
        down, drop = vectors.down_positive, self._drop
        propagated, count = dict(columns), count_of(width)
        for c in range(min(columns), self._lowest):
            propagated[c + 1] = b.add(propagated[c + 1], down(b, propagated[c], DIGIT))
        kept_columns = [propagated[c] for c in range(self._lowest, max(columns) + 1)]
        limbs = [
            self.multiply_add.add_shifted(b, down(b, low, drop), above, DIGIT - drop)
            for low, above in pairwise(kept_columns)
        ][: count - 1]
        if len(kept_columns) > count:  # what lies above is multiples of 2^64 of the highest limb
            high = down(b, kept_columns[count - 1], drop)
            limbs.append(b.add(high, vectors.up(b, kept_columns[count], DIGIT - drop)))
        else:  # of the highest column 52 bits count, the highest of them the sign
            high = vectors.up(b, kept_columns[-1], 64 - DIGIT)
            limbs.append(vectors.down(b, high, 64 - DIGIT + drop))
        return limbs
