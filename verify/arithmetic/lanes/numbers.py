"""Fixed-point numbers in lanes: limbs in radix 2^52, one vector of eight words each.

A number's limbs are words with signs, and their sum Σ limbᵢ 2^(52 i) is its value: sums are formed
limb by limb, and carries are left where they are until a product, a sign or 64-bit words are asked
for. Then they move up: all limbs but the highest are in [0, 2^52), the highest has the sign.

A product is formed exactly and rounded once, as `verify.arithmetic.wide.limbs.product` does it, to
the same bits. The multiply-add instruction takes 52 bits without a sign: the product of x − X 2^52n
and y − Y 2^52n, X and Y 1 where the number is negative, else 0, is formed from x y by taking X y
and Y x away n limbs higher.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import reduce
from itertools import pairwise

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.vectors import DIGIT, DOUBLES, WORDS, MultiplyAdd, splat
from verify.arithmetic.wide.limbs import Value

_MOST_WEIGHT = 1 << 9  # of sums whose carries have not moved: limbs stay below 2^62
_PRODUCT_WEIGHT = 4  # columns of up to 10 limbs, 4 bits shifted out of them at least


def count_of(width: int) -> int:
    """The limbs for so many bits, the sign among them."""
    return -(-width // DIGIT)


@dataclass(eq=False)
class Number:
    """Limbs from the lowest, each below `weight`·2^52 in size; `width` bits hold its value.

    `settled` are the limbs once carries have moved, and `negative` where it is; both are written
    once, where they are first asked for.
    """

    limbs: list[Value]
    width: int
    weight: int = 1
    settled: list[Value] | None = None
    negative: Value | None = None
    carried: list[Value] = field(default_factory=list)


class Numbers:
    """Operations on numbers with so many fraction bits."""

    def __init__(self, module: ir.Module, fraction: int, *, native: bool) -> None:
        self.fraction, self.multiply_add = fraction, MultiplyAdd(module, native=native)

    # -- carries ------------------------------------------------------------------------------

    def carry(self, b: ir.IRBuilder, x: Number) -> list[Value]:
        """The limbs after the carries have moved; of all but the highest 52 bits count."""
        if not x.carried:
            x.carried = [x.limbs[0]]
            for limb in x.limbs[1:]:
                x.carried.append(b.add(limb, vectors.down(b, x.carried[-1], DIGIT)))
        return x.carried

    def settle(self, b: ir.IRBuilder, x: Number) -> list[Value]:
        """The limbs, all but the highest in [0, 2^52), the highest with the sign."""
        if x.settled is None:
            *low, high = self.carry(b, x)
            x.settled = [*(vectors.masked(b, limb) for limb in low), high]
        return x.settled

    def negative(self, b: ir.IRBuilder, x: Number) -> Value:
        if x.negative is None:
            x.negative = b.icmp_signed("<", self.carry(b, x)[-1], splat(0))
        return x.negative

    def known(self, limbs: Sequence[Value], width: int) -> Number:
        """A number whose carries have moved."""
        limbs = list(limbs)
        return Number(limbs, width, settled=limbs, carried=limbs)

    def light(self, b: ir.IRBuilder, x: Number) -> Number:
        """The same number, its carries moved where it is a sum of many."""
        if x.weight < _MOST_WEIGHT:
            return x
        return self.known(self.settle(b, x), x.width)

    # -- sums and signs -----------------------------------------------------------------------

    def constant(self, raw: int, width: int) -> Number:
        count = count_of(width)
        limbs = [splat((raw >> DIGIT * i) % (1 << DIGIT)) for i in range(count - 1)]
        return self.known([*limbs, splat(raw >> DIGIT * (count - 1))], width)

    def add(self, b: ir.IRBuilder, x: Number, y: Number) -> Number:
        return self._by_limbs(b, b.add, x, y)

    def sub(self, b: ir.IRBuilder, x: Number, y: Number) -> Number:
        return self._by_limbs(b, b.sub, x, y)

    def _by_limbs(self, b: ir.IRBuilder, operation: object, x: Number, y: Number) -> Number:
        assert callable(operation)  # noqa: S101
        x, y = self.light(b, x), self.light(b, y)
        limbs = [operation(u, v) for u, v in zip(x.limbs, y.limbs, strict=True)]
        return Number(limbs, x.width, x.weight + y.weight)

    def neg(self, b: ir.IRBuilder, x: Number) -> Number:
        return Number([b.sub(splat(0), limb) for limb in x.limbs], x.width, x.weight)

    def choose(self, b: ir.IRBuilder, condition: Value, x: Number, y: Number) -> Number:
        """x where the condition holds, else y."""
        both = zip(self.settle(b, x), self.settle(b, y), strict=True)
        return self.known([b.select(condition, u, v) for u, v in both], x.width)

    def absolute(self, b: ir.IRBuilder, x: Number) -> Number:
        negative = self.negative(b, x)
        limbs = self.settle(b, x)
        return Number([b.select(negative, b.sub(splat(0), v), v) for v in limbs], x.width)

    def extended(self, b: ir.IRBuilder, x: Number, width: int) -> Number:
        """The same number in more limbs."""
        return Number(x.limbs + [splat(0)] * (count_of(width) - len(x.limbs)), width, x.weight)

    def less(self, b: ir.IRBuilder, x: Number, y: Number) -> Value:
        """Where x < y."""
        return self.negative(b, self.sub(b, x, y))

    def equal(self, b: ir.IRBuilder, x: Number, y: Number) -> Value:
        """Where x = y."""
        rest = self.settle(b, self.sub(b, x, y))
        return b.icmp_unsigned("==", reduce(b.or_, rest), splat(0))

    # -- products -----------------------------------------------------------------------------

    def product(self, b: ir.IRBuilder, x: Number, y: Number) -> Number:
        """x y / 2^fraction, rounded to the nearest, halves upwards."""
        count = len(x.limbs)
        lowest, drop = divmod(self.fraction, DIGIT)
        # Of the column above the result's highest limb the low bits are needed, or none.
        top = (self.fraction + x.width - 1) // DIGIT
        columns = self._columns(b, x, y, 1, top, {lowest: 1 << (drop - 1)})
        for c in range(1, lowest):
            columns[c + 1] = b.add(columns[c + 1], vectors.down(b, columns[c], DIGIT))
        kept = [columns[c] for c in range(lowest, top + 1)]
        shift = splat(1 << (DIGIT - drop))
        limbs = [
            self.multiply_add.low(b, vectors.down(b, low, drop), above, shift)
            for low, above in pairwise(kept)
        ][: count - 1]
        if len(kept) > count:  # what lies above is multiples of 2^64 of the highest limb
            high = vectors.down(b, kept[count - 1], drop)
            limbs.append(b.add(high, vectors.up(b, kept[count], DIGIT - drop)))
        else:  # of the highest column 52 bits count, the highest of them the sign
            high = vectors.up(b, kept[-1], 64 - DIGIT)
            limbs.append(vectors.down(b, high, 64 - DIGIT + drop))
        return Number(limbs, x.width, _PRODUCT_WEIGHT)

    def _columns(
        self, b: ir.IRBuilder, x: Number, y: Number, low: int, top: int, start: dict[int, int]
    ) -> dict[int, Value]:
        """Σ xᵢ yⱼ by columns from `low` to `top`, exactly but for what lies in columns below `low`
        and above `top`; the carries have not moved."""
        count = len(x.limbs)
        columns = {c: splat(start.get(c, 0)) for c in range(low, top + 1)}
        if x is y:
            mixed = self._signs(b, {c: splat(0) for c in columns}, x, x, count)
            for i in range(count):
                for j in range(i + 1, count):
                    self._multiply(b, mixed, self.carry(b, x)[i], self.carry(b, x)[j], i + j)
            columns = {c: b.add(v, b.add(mixed[c], mixed[c])) for c, v in columns.items()}
            for i, own in enumerate(self.carry(b, x)):
                self._multiply(b, columns, own, own, 2 * i)
            return columns
        columns = self._signs(b, columns, x, y, count)
        columns = self._signs(b, columns, y, x, count)
        for i, u in enumerate(self.carry(b, x)):
            for j, v in enumerate(self.carry(b, y)):
                self._multiply(b, columns, u, v, i + j)
        return columns

    def _signs(
        self, b: ir.IRBuilder, columns: dict[int, Value], x: Number, y: Number, count: int
    ) -> dict[int, Value]:
        """Less y, `count` columns higher, where x is negative."""
        taken = dict(columns)
        for j, limb in enumerate(self.settle(b, y)):
            if (c := count + j) in taken:
                less = b.sub(taken[c], limb)
                taken[c] = b.select(self.negative(b, x), less, taken[c])
        return taken

    def _multiply(
        self, b: ir.IRBuilder, columns: dict[int, Value], u: Value, v: Value, c: int
    ) -> None:
        if c in columns:
            columns[c] = self.multiply_add.low(b, columns[c], u, v)
        if c + 1 in columns:
            columns[c + 1] = self.multiply_add.high(b, columns[c + 1], u, v)

    # -- 64-bit words and doubles -------------------------------------------------------------

    def word(self, b: ir.IRBuilder, x: Number, index: int) -> Value:
        """The word of that index of the number in two's complement; 0 is the lowest."""
        first, total = 64 * index, None
        limbs = self.settle(b, x)
        for i, limb in enumerate(limbs):
            at, end = DIGIT * i - first, DIGIT * (i + 1) - first
            last = i == len(limbs) - 1
            if (end <= 0 and not last) or at >= 64:
                continue
            shift = b.ashr if last else b.lshr
            part = shift(limb, splat(min(-at, 63))) if at < 0 else vectors.up(b, limb, at)
            total = part if total is None else b.or_(total, part)
        assert total is not None  # noqa: S101
        return total

    def from_words(self, b: ir.IRBuilder, words: Sequence[Value]) -> Number:
        """A number of 64-bit words, the lowest first."""
        width = 64 * len(words)
        count = count_of(width)
        limbs = []
        for i in range(count):
            index, by = divmod(DIGIT * i, 64)
            last = i == count - 1  # it begins in the highest word, as that has more bits
            limb = (b.ashr if last else b.lshr)(words[index], splat(by))
            if index + 1 < len(words) and by > 64 - DIGIT:
                limb = b.or_(limb, vectors.up(b, words[index + 1], 64 - by))
            limbs.append(limb if last else vectors.masked(b, limb))
        return self.known(limbs, width)

    def to_double(self, b: ir.IRBuilder, x: Number) -> Value:
        """As `verify.arithmetic.wide.newton.to_double`, operation by operation."""
        count = x.width // 64
        high = b.sitofp(self.word(b, x, count - 1), DOUBLES)
        low = b.uitofp(self.word(b, x, count - 2), DOUBLES)
        unit = vectors.splat_double(2.0 ** (x.width - 64 - self.fraction))
        below = vectors.splat_double(2.0 ** (x.width - 128 - self.fraction))
        return b.fadd(b.fmul(high, unit), b.fmul(low, below))

    def from_double(self, b: ir.IRBuilder, value: Value, width: int) -> Number:
        """As `verify.arithmetic.wide.newton.from_double`; |value| < 2^(width − 1 − fraction)."""
        floor, absolute = (vectors.intrinsic(b.module, name) for name in ("floor", "fabs"))
        count = count_of(width)
        scale = vectors.splat_double(2.0 ** (self.fraction - DIGIT * (count - 1)))
        rest = b.fmul(b.call(absolute, [value]), scale)
        limbs: list[Value] = []
        for _ in range(count):
            whole = b.call(floor, [rest])
            limbs.insert(0, b.fptoui(whole, WORDS))
            rest = b.fmul(b.fsub(rest, whole), vectors.splat_double(2.0**DIGIT))
        negative = b.fcmp_ordered("<", value, vectors.splat_double(0.0))
        signed = [b.select(negative, b.sub(splat(0), limb), limb) for limb in limbs]
        return Number(signed, width)

    # -- what the language has ----------------------------------------------------------------

    def inside(self, b: ir.IRBuilder, x: Number, limit: Number) -> Value:
        """|x| < limit, by the highest words alone; see the translator of one orbit."""
        high, most = (self.word(b, v, v.width // 64 - 1) for v in (x, limit))
        moved = b.sub(b.add(high, most), splat(1))
        return b.icmp_unsigned("<", moved, b.sub(b.add(most, most), splat(1)))

    def shifted(self, b: ir.IRBuilder, x: Number, by: Value) -> Number:
        """x / 2^by rounded down, 0 ≤ by < 64, `by` a word in each lane."""
        limbs = self.settle(b, x)
        sign = vectors.down(b, limbs[-1], 63)
        far = b.icmp_unsigned(">=", by, splat(DIGIT))
        rest = b.select(far, b.sub(by, splat(DIGIT)), by)
        # By whole limbs first. The highest, whose sign fills it, is a limb like the others then.
        *low, high = limbs
        above = [*low[1:], high, sign]
        near = [b.select(far, v, u) for u, v in zip([*low, high], above, strict=True)]
        filled = [*near, sign]
        left = b.sub(splat(DIGIT), rest)
        moved = [
            b.or_(b.lshr(vectors.masked(b, u), rest), vectors.masked(b, b.shl(v, left)))
            for u, v in pairwise(filled[:-1])
        ]
        return self.known([*moved, b.ashr(near[-1], rest)], x.width)
