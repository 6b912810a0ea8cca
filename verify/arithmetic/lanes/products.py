"""Numbers in lanes, their carries and their products.

A number has limbs in radix 2^52, each a vector of signed words; its value is Σ limbᵢ 2^(52 i). Sums
are formed limb by limb, and carries stay in their limbs until a product, a sign or 64-bit words are
needed. Then the carries move up: all limbs but the highest are in [0, 2^52) afterwards, and the
highest has the sign.

A product has the bits of `verify.arithmetic.wide.limbs.product`: it is rounded once. If that saves
time, its lowest columns are left out; if they matter in some lane, the product is computed again
from all columns.

The factors may be words without a sign. A number is then x − X 2^(52 n), where X is 1 if it is
negative, else 0, and another y − Y 2^(52 n); their product is x y minus X y and Y x, both n limbs
higher.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.multiply_add import Columns, MultiplyAdd
from verify.arithmetic.lanes.vectors import LIMB_BITS, WORDS, splat
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.size import size_of

_MAX_WEIGHT = 1 << 9  # a sum of less weight needs no carries moved: its limbs stay below 2^62
_PRODUCT_WEIGHT = 8  # columns are below 1.5·2^58, and at least 4 bits are shifted out of them
_MIN_GUARD_BITS = 16  # bits kept below a product's last bit, so that it is seldom unsure
# If all columns from this one on are kept, less than a unit is left out, and it is rounded down.
_EXACT_COLUMN = 1
_COLUMN_BIAS = 1 << 58  # makes columns positive, for processors that shift down without the sign


def count_of(width: int) -> int:
    """Return the number of limbs for so many bits, the sign among them."""
    return -(-width // LIMB_BITS)


@dataclass(eq=False)
class LaneNumber:
    """A number as its limbs, the lowest first, each below `weight`·2^52 in size; its value fits in
    `width` bits.

    Written when they are first used, and once: `carried`, the limbs after carries have moved;
    `settled`, these cut to 52 bits; `factors`, the limbs as they are multiplied; `negative`, the
    lanes in which the number is negative.
    """

    limbs: list[Value]
    width: int
    weight: int = 1
    settled: list[Value] | None = None
    negative: Value | None = None
    carried: list[Value] = field(default_factory=list)
    factors: list[Value] = field(default_factory=list)


class Carries:
    """Operations on the carries of numbers with `fraction` fraction bits; the code of each is
    written once per number."""

    def __init__(self, fraction: int, multiply_add: MultiplyAdd) -> None:
        self.fraction, self.size, self.multiply_add = fraction, size_of(fraction), multiply_add

    def carry(self, b: ir.IRBuilder, x: LaneNumber) -> list[Value]:
        """Return the limbs after the carries have moved; only the low 52 bits of a limb count,
        except of the highest."""
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
        """Write the number's limbs and factors here, before a loop; LLVM drops what is not used."""
        self.settle(b, x)
        self.factors(b, x)
        self.negative(b, x)

    def from_settled(self, limbs: Sequence[Value], width: int) -> LaneNumber:
        """Return the number of limbs whose carries have moved."""
        limbs = list(limbs)
        return LaneNumber(limbs, width, settled=limbs, carried=limbs)

    def light(self, b: ir.IRBuilder, x: LaneNumber) -> LaneNumber:
        """Return the same number, with its carries moved if it is a sum of many numbers."""
        # A limb is below weight·2^52 in size, and overflows at 2^63: carries must move before.
        if x.weight < _MAX_WEIGHT:
            return x
        return self.from_settled(self.settle(b, x), x.width)


class Products(Carries):
    """Products of numbers with so many fraction bits."""

    def __init__(self, fraction: int, multiply_add: MultiplyAdd) -> None:
        super().__init__(fraction, multiply_add)
        # The result's last bit stands in column `_lowest`, above `_drop` other bits of it.
        self._lowest, self._drop = divmod(fraction, LIMB_BITS)
        first = self._lowest if self._drop >= _MIN_GUARD_BITS else self._lowest - 1
        self._first = first if multiply_add.leaves_out else _EXACT_COLUMN
        self._whole_products: dict[int, ir.Function] = {}

    def product(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> LaneNumber:
        """Return x y / 2^fraction, rounded to the nearest, halves upwards."""
        columns = self._columns(b, x, y, self._first)
        near = self._round(b, columns, x.width)
        if self._first == _EXACT_COLUMN:
            return LaneNumber(near, x.width, _PRODUCT_WEIGHT)
        unsure = vectors.any_of(b, self._unsure(b, columns[self._first]))
        entry, cold = b.block, b.append_basic_block("unsure")
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
            for value, block in zip(candidates, (entry, cold), strict=True):
                limb.add_incoming(value, block)
        return LaneNumber(limbs, x.width, _PRODUCT_WEIGHT)

    def _unsure(self, b: ir.IRBuilder, column: Value) -> Value:
        """Return the condition that the omitted columns may carry into the result."""
        bound = self._omission_bound(self._first)
        below = self._drop if self._first == self._lowest else LIMB_BITS
        rest = b.and_(b.add(column, splat(bound)), splat((1 << below) - 1))
        return b.icmp_signed("<", rest, splat(2 * bound))

    @staticmethod
    def _omission_bound(first: int) -> int:
        """Return a bound on the omitted part of a product, in units of the first kept column: less
        than one for each of the 2·first − 1 products in the two columns beneath it, and less than
        one for all columns further below."""
        return 2 * first

    def _whole_product(self, module: ir.Module, width: int) -> ir.Function:
        """Return a function for the product from all columns; it is not inlined, since it is hardly
        ever called."""
        if width in self._whole_products:
            return self._whole_products[width]
        count = count_of(width)
        result = ir.LiteralStructType([WORDS] * count)
        kind = ir.FunctionType(result, [WORDS] * (2 * count))
        function = ir.Function(module, kind, f"lanes_whole_product_{width}")
        self._whole_products[width] = function
        function.linkage = "internal"
        function.attributes.add("noinline")
        b = ir.IRBuilder(function.append_basic_block("entry"))
        x, y = (
            self.from_settled(vectors.settle(b, limbs), width)
            for limbs in (function.args[:count], function.args[count:])
        )
        packed = ir.Constant(result, ir.Undefined)
        for i, limb in enumerate(self._round(b, self._columns(b, x, y, _EXACT_COLUMN), width)):
            packed = b.insert_value(packed, limb, i)
        b.ret(packed)
        return function

    def _columns(
        self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber, first: int
    ) -> dict[int, Value]:
        """Return Σ xᵢ yⱼ plus half a unit of the result's last place, by columns from `first` on.

        The last column holds bit `fraction` + `width`. If it lies above the result's highest limb,
        only its low bits are needed; else the highest limb has room for the sign and for carries
        that have not moved.
        """
        top, count = (self.fraction + x.width) // LIMB_BITS, len(x.limbs)
        start = self._start(first, top)
        start[self._lowest] += 1 << (self._drop - 1)
        columns = Columns(self.multiply_add, first, top, start, exact=first == _EXACT_COLUMN)
        u, v = self.factors(b, x), self.factors(b, y)
        if x is not y:
            self._take_signs(b, columns, x, y)
            self._take_signs(b, columns, y, x)
            for i in range(count):
                for j in range(count):
                    columns.add(b, u[i], v[j], i + j, signed=count - 1 in (i, j))
            return columns.total(b)
        mixed = Columns(self.multiply_add, first, top, exact=first == _EXACT_COLUMN)
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
        """Return numbers to add to the columns, so that all but the highest are not negative; their
        sum is 0."""
        above = 0 if vectors.SHIFTS_SIGNS else _COLUMN_BIAS
        start = dict.fromkeys(range(first, top + 1), 0)
        for c in range(first, top):
            start[c] += above
            start[c + 1] -= above >> LIMB_BITS
        return start

    def _take_signs(self, b: ir.IRBuilder, columns: Columns, x: LaneNumber, y: LaneNumber) -> None:
        """Subtract y·2^(52 n), n the number of limbs of x, in the lanes where x is negative; do
        nothing if factors have signs."""
        if self.multiply_add.signed:
            return
        for j, limb in enumerate(self.settle(b, y)):
            total = columns.sums.get(len(x.limbs) + j)
            if total is not None:
                reduced = b.sub(total.vector, limb)
                total.vector = b.select(self.negative(b, x), reduced, total.vector)

    def _round(self, b: ir.IRBuilder, columns: Mapping[int, Value], width: int) -> list[Value]:
        """Return the limbs of the result, from the kept columns."""
        down, drop = vectors.down_positive, self._drop
        propagated, count = dict(columns), count_of(width)
        for c in range(min(columns), self._lowest):
            propagated[c + 1] = b.add(propagated[c + 1], down(b, propagated[c], LIMB_BITS))
        kept_columns = [propagated[c] for c in range(self._lowest, max(columns) + 1)]
        limbs = [
            self.multiply_add.add_shifted(b, down(b, low, drop), above, LIMB_BITS - drop)
            for low, above in pairwise(kept_columns)
        ][: count - 1]
        if len(kept_columns) > count:  # its higher bits are shifted out of the word
            high = down(b, kept_columns[count - 1], drop)
            limbs.append(b.add(high, vectors.up(b, kept_columns[count], LIMB_BITS - drop)))
        else:  # the low 52 bits of the highest column count, the highest of these as the sign
            high = vectors.up(b, kept_columns[-1], 64 - LIMB_BITS)
            limbs.append(vectors.down(b, high, 64 - LIMB_BITS + drop))
        return limbs
