"""sin and cos of numbers in lanes, to the bits that `verify.arithmetic.wide.functions` gives.

x = k·2π/4096 + r; sin and cos of the first from a table of a quarter turn, of |r| ≤ π/4096 by
Taylor polynomials, in fractions of n limbs. The function of one orbit loses at most `lost_by_one`
units of 2^(2 − W) before it rounds, this one at most `_lost` units of 2^−52n. So where the value is
farther than both together from where rounding changes, both round alike. Where it is not, in one of
a hundred lanes, the function of one orbit is asked.

What is lost here, in units of 2^−52n, with n ≤ 20 limbs: r is within 2 (the table step has 52 bits
more than a fraction, and is multiplied by |k| < 2^26); t = u² with u = 2^10 |r| within 2^11·2 + 2n;
the series' terms lose 2n + 2 each, twenty of them at most beside what is left out; divided by 2^10
and 2^20 that leaves less than 8 of sin r, and of 1 − cos r. The products with the table's values,
which are within 1, lose 2n + 9 each. Together that is less than 4 n + 40.

What one orbit's function loses, with m limbs of 64 bits, follows from the same count: r within 2
units of 2^−W, sin r and 1 − cos r within 8, table values within ½ unit of 2^(2 − W), two products
that lose 2 m + 3 each: less than 4 m + 16 units of 2^(2 − W).
"""

from collections.abc import Sequence
from fractions import Fraction
from math import factorial

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.fractions import (
    Fractions,
    added,
    constant,
    negated,
    settled,
    taken,
)
from verify.arithmetic.lanes.numbers import Number, Numbers
from verify.arithmetic.lanes.vectors import DIGIT, LANES, WORDS, splat
from verify.arithmetic.wide.functions import arb_integer
from verify.arithmetic.wide.limbs import I64, Value

_ANGLES = 4096  # table steps of a full turn
_QUARTER = _ANGLES // 4
_SHIFT = 10  # |r| < 2^−10


def lost_by_one(width: int) -> int:
    """Units of 2^(2 − width) that one orbit's function loses at most before it rounds."""
    return 4 * (width // 64) + 16


def _lost(count: int) -> int:
    return 4 * count + 40


class Circle:
    """sin and cos for numbers of one width."""

    def __init__(self, module: ir.Module, width: int, numbers: Numbers) -> None:
        self.module, self.width, self.numbers = module, width, numbers
        self.count = -(-width // DIGIT)
        self.spare = DIGIT * self.count - numbers.fraction  # a fraction's bits below a number's
        self.fractions = Fractions(numbers.multiply_add, self.count)

    def cos_sin(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Number]]:
        """(where they are not known to be those of one orbit, [cos x, sin x])."""
        k, r = self._reduced(b, x)
        negative = b.icmp_signed("<", r[-1], splat(0))
        sine, versine = self._small(b, settled(b, negated(b, negative, r)))
        index = b.and_(k, splat(_QUARTER - 1))
        s, c = self._entries(b, index), self._entries(b, b.sub(splat(_QUARTER), index))
        product = self.fractions.product
        along = negated(b, negative, product(b, c, sine))
        across = negated(b, negative, product(b, s, sine))
        sin = added(b, taken(b, s, product(b, s, versine)), along)
        cos = taken(b, taken(b, c, product(b, c, versine)), across)
        # A quarter further cos is −sin and sin is cos, two further both change their signs.
        odd = b.icmp_unsigned("!=", b.and_(k, splat(_QUARTER)), splat(0))
        half = b.icmp_unsigned("!=", b.and_(k, splat(2 * _QUARTER)), splat(0))
        cos, sin = (
            [b.select(odd, u, v) for u, v in zip(one, other, strict=True)]
            for one, other in ((sin, cos), (cos, sin))
        )
        unsure_cos, cosine = self._rounded(b, negated(b, b.xor(odd, half), cos))
        unsure_sin, sine_of_x = self._rounded(b, negated(b, half, sin))
        return b.or_(unsure_cos, unsure_sin), [cosine, sine_of_x]

    def _reduced(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Value]]:
        """(k, r): x = k·2π/4096 + r, r in fractions' units with its sign."""
        with working_precision(self.width + 256):
            step = 2 * flint.arb.pi() / _ANGLES
            unit = arb_integer(step, DIGIT * (self.count + 1))
            inverse = float((1 / step).mid())
        near = b.fmul(self.numbers.to_double(b, x), vectors.splat_double(inverse))
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "rint"), [near]), WORDS)
        below = b.icmp_signed("<", k, splat(0))
        size = b.select(below, b.sub(splat(0), k), k)
        # |k|·unit, whose lowest limb is below a fraction's units. What is above them is whole
        # numbers, which x has as well, so that they need not be known.
        multiple = settled(b, self._times(b, constant(unit, self.count + 1), size))[1:]
        stretched = self._times(b, self.numbers.settle(b, x), splat(1 << self.spare))
        rest = settled(b, taken(b, stretched, negated(b, below, multiple)))
        # Of the highest limb 52 bits count, the highest of them the sign.
        high = vectors.down(b, vectors.up(b, rest[-1], 64 - DIGIT), 64 - DIGIT)
        return k, [*rest[:-1], high]

    def _times(self, b: ir.IRBuilder, limbs: Sequence[Value], factor: Value) -> list[Value]:
        """The limbs of the product with one limb, but for what goes beyond the highest."""
        multiply_add, columns = self.numbers.multiply_add, [splat(0)] * len(limbs)
        for i, limb in enumerate(limbs):
            columns[i] = multiply_add.low(b, columns[i], limb, factor)
            if i + 1 < len(limbs):
                columns[i + 1] = multiply_add.high(b, columns[i + 1], limb, factor)
        return columns

    def _small(self, b: ir.IRBuilder, size: Sequence[Value]) -> tuple[list[Value], list[Value]]:
        """sin |r| and 1 − cos |r|."""
        fractions = self.fractions
        u = settled(b, [vectors.up(b, limb, _SHIFT) for limb in size])
        t = settled(b, fractions.product(b, u, u))
        many = range(8 * self.count)
        by_u = fractions.series(b, t, [Fraction(1, factorial(2 * j + 1)) for j in many], 2 * _SHIFT)
        by_t = fractions.series(b, t, [Fraction(1, factorial(2 * j + 2)) for j in many], 2 * _SHIFT)
        sine = fractions.shifted(b, settled(b, fractions.product(b, u, by_u)), _SHIFT)
        versine = fractions.shifted(b, settled(b, fractions.product(b, t, by_t)), 2 * _SHIFT)
        return sine, versine

    def _entries(self, b: ir.IRBuilder, index: Value) -> list[Value]:
        """sin of so many table steps in the first quarter."""
        table, first = self._table(), b.mul(index, splat(self.count))
        found = [ir.Constant(WORDS, ir.Undefined)] * self.count
        for lane in range(LANES):
            at = b.extract_element(first, ir.Constant(I64, lane))
            for i in range(self.count):
                path = [ir.Constant(I64, 0), b.add(at, ir.Constant(I64, i))]
                limb = b.load(b.gep(table, path, inbounds=True), typ=I64)
                found[i] = b.insert_element(found[i], limb, ir.Constant(I64, lane))
        return found

    def _table(self) -> ir.GlobalVariable:
        """sin of all table steps of a quarter, limb after limb; 1 is the fraction next to it."""
        name, places = "lanes_sines", DIGIT * self.count
        if name not in self.module.globals:
            with working_precision(self.width + 256):
                step = 2 * flint.arb.pi() / _ANGLES
                exact = [arb_integer((step * k).sin(), places) for k in range(_QUARTER + 1)]
            values = [min(value, 2**places - 1) for value in exact]
            rows = [(v >> DIGIT * i) % (1 << DIGIT) for v in values for i in range(self.count)]
            kind = ir.ArrayType(I64, len(rows))
            table = ir.GlobalVariable(self.module, kind, name)
            table.linkage, table.global_constant = "internal", True
            table.initializer = ir.Constant(kind, rows)
        return self.module.globals[name]

    def _rounded(self, b: ir.IRBuilder, value: Sequence[Value]) -> tuple[Value, Number]:
        """(where it may round otherwise, the number) of a fraction with its sign."""
        total = settled(b, added(b, value, constant(1 << (self.spare - 1), self.count)))
        # 2^(2 − W) is 2^(spare − 14) units.
        lost = _lost(self.count) + (lost_by_one(self.width) << (self.spare - 14))
        rest = b.and_(b.add(total[0], splat(lost)), splat((1 << self.spare) - 1))
        unsure = b.icmp_unsigned("<", rest, splat(2 * lost))
        limbs = self.fractions.shifted(b, total, self.spare)
        return unsure, self.numbers.known(limbs, self.width)
