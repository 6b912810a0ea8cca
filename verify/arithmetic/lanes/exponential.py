"""exp, sinh and cosh in lanes, to the bits that `verify.arithmetic.wide.functions` gives.

x = k·ln 2/2^12 − ρ with 0 ≤ ρ < 2^−12; 2^(i/2^12), i = k mod 2^12, from a table, and by its series

    1 − e^−ρ = ρ (1 − ρ/2 + ρ²/6 − …),

in fractions of n limbs; so e^x = m·2^a with m from ½ to 1. The function of one orbit cuts what is
below a number's last bit, and has lost at most `lost_by_one` units of 2^(2 − W) of twice m before;
this one loses at most `_lost` units of 2^−52n of m. So where m, less and more both together, is cut
to the same number, that is its result too. Where it is not, in three of a thousand lanes near
x = 0 and in all beyond e^x = 2^13, the function of one orbit is asked.

What is lost here, in units of 2^−52n, with n ≤ 8 limbs: ρ is within 2, and u = 2^12 ρ within 2^13;
the series' terms lose 2n + 2 each, forty of them at most, and what is left out is less; with the
product by u, that loses 2n, and divided by 2^12 this leaves less than 8 of 1 − e^−ρ. The table's
value, half of 2^(i/2^12), is within 1, and the product with it loses 2n: in all less than 2 n + 16.

What one orbit's function loses, with w limbs of 64 bits, follows from the same count: e^ρ − 1 is
within 6 units of 2^−W, the table's value within ½ of 2^(2 − W), and the product loses 2 w + 3: less
than `lost_by_one`.
"""

from fractions import Fraction
from functools import cache
from math import factorial

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.circle import lost_in_units
from verify.arithmetic.lanes.fractions import Fractions, add, constant, negate, settle, subtract
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.reduction import Reduction
from verify.arithmetic.lanes.table import Table, rows_of
from verify.arithmetic.lanes.vectors import CONDITIONS, DIGIT, WORDS, splat, splat_double
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.functions import arb_integer
from verify.arithmetic.wide.limbs import Value

_OCTAVE = 1 << 12  # table steps of a factor 2
_SHIFT = 12  # ρ < 2^−12
_MARGIN = 2.0**-20  # of k, so that ρ is surely not negative
_MOST, _LEAST = 12, -47  # of a, beyond which one orbit's function is asked


def _units_lost(count: int) -> int:
    return 2 * count + 16


@cache
def _powers_of(count: int) -> ir.Constant:
    """Return half of 2^(i/_OCTAVE), the same in all modules."""
    with working_precision(DIGIT * count + 256):
        step = flint.arb(2).log() / _OCTAVE
        values = [arb_integer((step * i).exp(), DIGIT * count - 1) for i in range(_OCTAVE)]
    return rows_of(values, count)


class Exponential:
    """exp, sinh and cosh for numbers of one format: (where they are not known, [the number])."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers = module, numbers
        self.reduction = Reduction(numbers, lambda: flint.arb(2).log() / _OCTAVE)
        self.count, self.below = self.reduction.count, DIGIT * self.reduction.count - numbers.size
        self.fractions = Fractions(numbers.multiply_add, self.count)
        self._table: Table | None = None

    def exp(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Number]]:
        """Return e^x."""
        k, rho = self._reduce(b, x)
        half = self._powers().entries(b, vectors.each(b, b.and_(k, splat(_OCTAVE - 1))))
        mantissa = subtract(b, half, self.fractions.product(b, half, self._small(b, rho)))
        a = vectors.down(b, k, _OCTAVE.bit_length() - 1)
        # Of m, which is half of one orbit's mantissa.
        lost = _units_lost(self.count) + lost_in_units(self.numbers.fraction, self.count, 1)
        # The number is 2^(F + 16) m / 2^(15 − a); where that is no shift from 1 to 63, one orbit is
        # asked.
        in_range = b.and_(
            b.icmp_signed("<=", a, splat(_MOST)), b.icmp_signed(">=", a, splat(_LEAST))
        )
        by = b.select(in_range, b.sub(splat(15), a), splat(1))
        margin = constant(lost, self.count)
        # The mantissa minus and plus all that was lost on both sides: where both are cut to one
        # number, so is the one of a single orbit.
        low, high = (
            self._cut(b, settle(b, move(b, mantissa, margin)), by) for move in (subtract, add)
        )
        difference = splat(0)
        for u, v in zip(low.limbs, high.limbs, strict=True):
            difference = b.or_(difference, b.xor(u, v))
        return b.or_(b.not_(in_range), b.icmp_unsigned("!=", difference, splat(0))), [low]

    def cosh(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Number]]:
        """Return (e^x + e^−x)/2, rounded down."""
        unsure, up, down = self._both(b, x)
        return unsure, [self.numbers.shift_down(b, self.numbers.add(b, up, down), splat(1))]

    def sinh(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Number]]:
        """Return (e^x − e^−x)/2, rounded down."""
        unsure, up, down = self._both(b, x)
        return unsure, [self.numbers.shift_down(b, self.numbers.sub(b, up, down), splat(1))]

    def _both(self, b: ir.IRBuilder, x: Number) -> tuple[Value, Number, Number]:
        unsure, (up,) = self.exp(b, x)
        minus = self.numbers.neg(b, x)
        unsure_too, (down,) = self.exp(b, minus)
        return b.or_(unsure, unsure_too), up, down

    def _reduce(self, b: ir.IRBuilder, x: Number) -> tuple[Value, list[Value]]:
        """Return (k, ρ), all limbs of ρ without a sign."""
        near = b.fadd(self.reduction.steps(b, x), splat_double(_MARGIN))
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "ceil"), [near]), WORDS)
        everywhere = ir.Constant(CONDITIONS, [1] * LANES)
        return k, settle(b, negate(b, everywhere, self.reduction.rest(b, x, k)))

    def _small(self, b: ir.IRBuilder, rho: list[Value]) -> list[Value]:
        """Return 1 − e^−ρ."""
        fractions = self.fractions
        u = fractions.shift_up(b, rho, _SHIFT)
        coefficients = [Fraction(1, factorial(j + 1)) for j in range(8 * self.count)]
        (series,) = fractions.series(b, u, coefficients, shift=_SHIFT)
        return fractions.shift_down(b, settle(b, fractions.product(b, u, series)), _SHIFT)

    def _cut(self, b: ir.IRBuilder, mantissa: list[Value], by: Value) -> Number:
        """Return 2^(F + 16) m / 2^by, rounded down."""
        if self.below:
            mantissa = self.fractions.shift_down(b, mantissa, self.below)
        return self.numbers.shift_down(
            b, self.numbers.from_settled(mantissa, self.numbers.size), by
        )

    def _powers(self) -> Table:
        if self._table is None:
            rows = _powers_of(self.count)
            self._table = Table(self.module, "lanes_powers", rows, self.count)
        return self._table
