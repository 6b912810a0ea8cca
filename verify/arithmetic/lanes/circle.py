"""sin and cos of numbers in lanes, to the bits that `verify.arithmetic.wide.functions` gives.

x = k·2π/2^14 + r; sin and cos of the first from a table of a quarter turn, of |r| ≤ π/2^14 by
Taylor polynomials, in fractions of n limbs. The function of one orbit, whose numbers take W bits in
words of 64, loses at most `lost_by_one` units of 2^(2 − W) before it rounds, this one at most
`_lost` units of 2^−52n. So where the value is farther than both together from where rounding
changes, both round alike. Where it is not, in one of a hundred lanes, the function of one orbit is
asked.

What is lost here, in units of 2^−52n, with n ≤ 20 limbs: r is within 2; t = u² with u = 2^12 |r|
within 2^13·2 + 2n; the series' terms lose 2n + 2 each, twenty of them at most beside what is left
out; divided by 2^12 and 2^24 that leaves less than 8 of sin r, and of 1 − cos r. The products with
the table's values, which are within 1, lose 2n + 9 each. Together that is less than 4 n + 40.

What one orbit's function loses, with m limbs of 64 bits, follows from the same count: r within 2
units of 2^−W, sin r and 1 − cos r within 8, table values within ½ unit of 2^(2 − W), two products
that lose 2 m + 3 each: less than 4 m + 16 units of 2^(2 − W).
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from math import factorial

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.fractions import Fractions, add, constant, negate, settle, subtract
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.reduction import Reduction
from verify.arithmetic.lanes.table import Table, rows_of
from verify.arithmetic.lanes.vectors import DIGIT, WORDS, splat
from verify.arithmetic.wide.functions import arb_integer
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.limbs import constant as word
from verify.arithmetic.wide.size import width_of

_ANGLES = 1 << 14  # table steps of a full turn
_QUARTER = _ANGLES // 4
_SHIFT = 12  # |r| < 2^−12


def lost_by_one(fraction: int) -> int:
    """Return the units of 2^(2 − W) that one orbit's function loses at most before it rounds."""
    return 4 * (width_of(fraction) // 64) + 16


def lost_in_units(fraction: int, count: int, place: int) -> int:
    """Return `lost_by_one` units of 2^(place − W) in those of 2^−52·count, or a little more."""
    lost, shift = lost_by_one(fraction), place + DIGIT * count - width_of(fraction)
    return lost << shift if shift >= 0 else -(-lost >> -shift)


def _units_lost(count: int) -> int:
    return 4 * count + 40


@cache
def _sines_of(count: int) -> ir.Constant:
    """Return sin of all table steps of a quarter, the same in all modules."""
    with working_precision(DIGIT * count + 256):
        step = 2 * flint.arb.pi() / _ANGLES
        values = [arb_integer((step * k).sin(), DIGIT * count) for k in range(_QUARTER + 1)]
    return rows_of(values, count)


class Circle:
    """sin and cos for numbers of one format."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers = module, numbers
        self.reduction = Reduction(numbers, lambda: 2 * flint.arb.pi() / _ANGLES)
        self.count, self.spare = self.reduction.count, self.reduction.spare
        self._table: Table | None = None
        self.fractions = Fractions(numbers.multiply_add, self.count)

    def cos_sin(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Number]]:
        """Return (where they are not known to be those of one orbit, [cos x, sin x])."""
        # k in float64 may be off by one where x/step is near a half-integer: r is then a little
        # above half a step, which the bound of |r| allows for.
        near = self.reduction.steps(b, x)
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "rint"), [near]), WORDS)
        r = self.reduction.rest(b, x, k)
        negative = b.icmp_signed("<", r[-1], splat(0))
        sine, versine = self._small(b, settle(b, negate(b, negative, r)))
        rows = vectors.each(b, b.and_(k, splat(_QUARTER - 1)))
        s = self._sines().entries(b, rows)
        c = self._sines().entries(b, [b.sub(word(_QUARTER, 64), row) for row in rows])
        product = self.fractions.product
        along = negate(b, negative, product(b, c, sine))
        across = negate(b, negative, product(b, s, sine))
        sin = add(b, subtract(b, s, product(b, s, versine)), along)
        cos = subtract(b, subtract(b, c, product(b, c, versine)), across)
        # A quarter further cos is −sin and sin is cos, two further both change their signs.
        odd = b.icmp_unsigned("!=", b.and_(k, splat(_QUARTER)), splat(0))
        half = b.icmp_unsigned("!=", b.and_(k, splat(2 * _QUARTER)), splat(0))
        cos, sin = (
            [b.select(odd, u, v) for u, v in zip(one, other, strict=True)]
            for one, other in ((sin, cos), (cos, sin))
        )
        unsure_cos, cosine = self._round(b, negate(b, b.xor(odd, half), cos))
        unsure_sin, sine_of_x = self._round(b, negate(b, half, sin))
        return b.or_(unsure_cos, unsure_sin), [cosine, sine_of_x]

    def _small(self, b: ir.IRBuilder, size: Sequence[Value]) -> tuple[list[Value], list[Value]]:
        """Return sin |r| and 1 − cos |r|."""
        fractions = self.fractions
        u = fractions.shift_up(b, size, _SHIFT)
        t = settle(b, fractions.product(b, u, u))
        many = range(8 * self.count)
        both = ([Fraction(1, factorial(2 * j + k)) for j in many] for k in (1, 2))
        by_u, by_t = fractions.series(b, t, *both, shift=2 * _SHIFT)
        sine = fractions.shift_down(b, settle(b, fractions.product(b, u, by_u)), _SHIFT)
        versine = fractions.shift_down(b, settle(b, fractions.product(b, t, by_t)), 2 * _SHIFT)
        return sine, versine

    def _sines(self) -> Table:
        if self._table is None:
            rows = _sines_of(self.count)
            self._table = Table(self.module, "lanes_sines", rows, self.count)
        return self._table

    def _round(self, b: ir.IRBuilder, value: Sequence[Value]) -> tuple[Value, Number]:
        """Return (where it may round otherwise, the number) of a fraction with its sign."""
        total = settle(b, add(b, value, constant(1 << (self.spare - 1), self.count)))
        lost = _units_lost(self.count) + lost_in_units(self.numbers.fraction, self.count, 2)
        rest = b.and_(b.add(total[0], splat(lost)), splat((1 << self.spare) - 1))
        unsure = b.icmp_unsigned("<", rest, splat(2 * lost))
        limbs = self.fractions.shift_down(b, total, self.spare)
        return unsure, self.numbers.from_settled(limbs, self.numbers.size)
