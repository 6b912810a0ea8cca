"""Fixed-point numbers in lanes: their sums, signs, 64-bit words and doubles."""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise
from typing import NamedTuple

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.products import LaneNumber, Products, count_of
from verify.arithmetic.lanes.vectors import DOUBLES, LIMB_BITS, WORDS, splat, splat_double
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.newton import units_of_words
from verify.arithmetic.wide.size import WORD, words_of


class Numbers(Products):
    """Operations on numbers with so many fraction bits."""

    # -- sums and signs -----------------------------------------------------------------------

    def constant(self, raw: int, width: int) -> LaneNumber:
        count = count_of(width)
        limbs = [splat((raw >> LIMB_BITS * i) % (1 << LIMB_BITS)) for i in range(count - 1)]
        return self.from_settled([*limbs, splat(raw >> LIMB_BITS * (count - 1))], width)

    def add(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> LaneNumber:
        return self._by_limbs(b, b.add, x, y)

    def sub(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> LaneNumber:
        return self._by_limbs(b, b.sub, x, y)

    def _by_limbs(
        self, b: ir.IRBuilder, operation: object, x: LaneNumber, y: LaneNumber
    ) -> LaneNumber:
        assert callable(operation)  # noqa: S101
        x, y = self.light(b, x), self.light(b, y)
        limbs = [operation(u, v) for u, v in zip(x.limbs, y.limbs, strict=True)]
        return LaneNumber(limbs, x.width, x.weight + y.weight)

    def neg(self, b: ir.IRBuilder, x: LaneNumber) -> LaneNumber:
        return LaneNumber([b.sub(splat(0), limb) for limb in x.limbs], x.width, x.weight)

    def choose(self, b: ir.IRBuilder, condition: Value, x: LaneNumber, y: LaneNumber) -> LaneNumber:
        """Return x where the condition holds, else y."""
        pairs = zip(self.settle(b, x), self.settle(b, y), strict=True)
        return self.from_settled([b.select(condition, u, v) for u, v in pairs], x.width)

    def absolute(self, b: ir.IRBuilder, x: LaneNumber) -> LaneNumber:
        negative = self.negative(b, x)
        limbs = self.settle(b, x)
        return LaneNumber([b.select(negative, b.sub(splat(0), v), v) for v in limbs], x.width)

    def extend(self, b: ir.IRBuilder, x: LaneNumber, width: int) -> LaneNumber:
        """Return the same number with `width` bits."""
        return LaneNumber(x.limbs + [splat(0)] * (count_of(width) - len(x.limbs)), width, x.weight)

    def less(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> Value:
        """Return the condition x < y."""
        return self.negative(b, self.sub(b, x, y))

    def equal(self, b: ir.IRBuilder, x: LaneNumber, y: LaneNumber) -> Value:
        """Return the condition x = y."""
        rest = self.settle(b, self.sub(b, x, y))
        return b.icmp_unsigned("==", reduce(b.or_, rest), splat(0))

    # -- 64-bit words and doubles -------------------------------------------------------------

    def words(self, b: ir.IRBuilder, x: LaneNumber) -> list[Value]:
        """Return the words of the number in two's complement, the lowest first."""
        return [self._word(b, x, WORD * index) for index in range(words_of(x.width))]

    def _leading(self, b: ir.IRBuilder, x: LaneNumber, beneath: int = 0) -> Value:
        """Return the leading word, or a word beneath it, as `verify.arithmetic.wide.limbs.leading`
        does."""
        return self._word(b, x, x.width - WORD * (beneath + 1))

    def _word(self, b: ir.IRBuilder, x: LaneNumber, first: int) -> Value:
        """Return 64 bits of the number in two's complement, beginning with bit `first`."""
        total = None
        limbs = self.settle(b, x)
        for i, limb in enumerate(limbs):
            start, end = LIMB_BITS * i - first, LIMB_BITS * (i + 1) - first
            last = i == len(limbs) - 1
            if (end <= 0 and not last) or start >= 64:
                continue
            shift = b.ashr if last else b.lshr
            part = shift(limb, splat(min(-start, 63))) if start < 0 else vectors.up(b, limb, start)
            total = part if total is None else b.or_(total, part)
        assert total is not None  # noqa: S101
        return total

    def from_words(self, b: ir.IRBuilder, words: Sequence[Value], width: int) -> LaneNumber:
        """Return the number of `width` bits that stands in 64-bit words, the lowest first."""
        count = count_of(width)
        limbs = []
        for i in range(count):
            index, shift = divmod(LIMB_BITS * i, 64)
            last = i == count - 1  # the limb with the sign, which may stand in the next word
            highest = index == len(words) - 1
            limb = (b.ashr if last and highest else b.lshr)(words[index], splat(shift))
            if not highest and (last or shift > 64 - LIMB_BITS):
                limb = b.or_(limb, vectors.up(b, words[index + 1], 64 - shift))
            limbs.append(limb if last else vectors.mask(b, limb))
        return self.from_settled(limbs, width)

    def to_double(self, b: ir.IRBuilder, x: LaneNumber) -> Value:
        """Convert as `verify.arithmetic.wide.newton.to_double` does, operation by operation."""
        high = b.sitofp(self._leading(b, x), DOUBLES)
        low = b.uitofp(self._leading(b, x, 1), DOUBLES)
        unit, below = map(splat_double, units_of_words(x.width - self.size))
        return b.fadd(b.fmul(high, unit), b.fmul(low, below))

    def from_double(self, b: ir.IRBuilder, value: Value) -> LaneNumber:
        """Convert as `verify.arithmetic.wide.newton.from_double` does; |value| < 2^15."""
        floor, absolute = (vectors.intrinsic(b.module, name) for name in ("floor", "fabs"))
        count = count_of(self.size)
        scale = splat_double(2.0 ** (self.fraction - LIMB_BITS * (count - 1)))
        rest = b.fmul(b.call(absolute, [value]), scale)
        limbs: list[Value] = []
        for _ in range(count):
            integer = b.call(floor, [rest])
            limbs.insert(0, b.fptoui(integer, WORDS))
            rest = b.fmul(b.fsub(rest, integer), splat_double(2.0**LIMB_BITS))
        negative = b.fcmp_ordered("<", value, splat_double(0.0))
        signed = [b.select(negative, b.sub(splat(0), limb), limb) for limb in limbs]
        return LaneNumber(signed, self.size)

    # -- calls of the language ----------------------------------------------------------------

    def inside(self, b: ir.IRBuilder, x: LaneNumber, limit: LaneNumber) -> Value:
        """Return a condition that implies |x| < limit, from the leading bits alone; see
        `verify.arithmetic.wide.one_orbit.OneOrbit.inside`."""
        high, most = (self._leading(b, v) for v in (x, limit))
        biased = b.sub(b.add(high, most), splat(1))
        return b.icmp_unsigned("<", biased, b.sub(b.add(most, most), splat(1)))

    def shift_down(self, b: ir.IRBuilder, x: LaneNumber, shift: Value) -> LaneNumber:
        """Return x / 2^shift rounded down, 0 ≤ shift < 64, `shift` a word in each lane."""
        limbs = self.settle(b, x)
        sign = vectors.down(b, limbs[-1], 63)
        far = b.icmp_unsigned(">=", shift, splat(LIMB_BITS))
        rest = b.select(far, b.sub(shift, splat(LIMB_BITS)), shift)
        # First the number is shifted by 0 or 1 limb; its sign then fills a new highest limb.
        *low, high = limbs
        above = [*low[1:], high, sign]
        near = [b.select(far, v, u) for u, v in zip([*low, high], above, strict=True)]
        filled = [*near, sign]
        complement = b.sub(splat(LIMB_BITS), rest)
        shifted = [
            b.or_(b.lshr(vectors.mask(b, u), rest), vectors.mask(b, b.shl(v, complement)))
            for u, v in pairwise(filled[:-1])
        ]
        return self.from_settled([*shifted, b.ashr(near[-1], rest)], x.width)


class FunctionValues(NamedTuple):
    """The values of a function in lanes.

    `valid`: the lanes in which the function has values; None for all. `unsure`: the lanes in which
    a value may be rounded otherwise than for one orbit; None for no lane.
    """

    values: Sequence[LaneNumber]
    valid: Value | None = None
    unsure: Value | None = None
