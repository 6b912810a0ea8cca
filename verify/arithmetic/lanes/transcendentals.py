"""sin, cos, exp, sinh and cosh in lanes, with the bits of `verify.arithmetic.wide.table_series`.

All is in fractions of n limbs of 52 bits. The functions of one orbit have numbers of W bits in m
words of 64. Each says in which lanes it is unsure of its last bit, and there the function of one
orbit is asked.

sin and cos: x = k·2π/2^14 + r; sin and cos of the first from a table of a quarter turn, of
|r| ≤ π/2^14 by Taylor polynomials. One orbit's function loses at most `lost_by_one` units of
2^(2 − W) before it rounds, this one at most `_lost_of_circle` units of 2^−52n. So if the value
is farther than both together from where rounding changes, both round alike; in one of a hundred
lanes it is not. What is lost here, in units of 2^−52n, with n ≤ 20: r is within 2; t = u² with
u = 2^12 |r| within 2^13·2 + 2n; the series' terms lose 2n + 2 each, twenty of them at most beside
what is left out; divided by 2^12 and 2^24 that leaves less than 8 of sin r, and of 1 − cos r. The
products with the table's values, which are within 1, lose 2n + 9 each: in all less than 4 n + 40.
What one orbit's function loses follows from the same count: r within 2 units of 2^−W, sin r and
1 − cos r within 8, table values within ½ unit of 2^(2 − W), two products that lose 2 m + 3 each:
less than 4 m + 16 units of 2^(2 − W).

exp: x = k·ln 2/2^12 − ρ with 0 ≤ ρ < 2^−12; 2^(i/2^12), i = k mod 2^12, from a table, and by its
series 1 − e^−ρ = ρ (1 − ρ/2 + ρ²/6 − …); so e^x = c·2^a with c from ½ to 1. One orbit's function
cuts what is below a number's last bit, and has lost at most `lost_by_one` units of 2^(2 − W) of
twice c before; this one loses at most `_lost_of_exponential` units of 2^−52n of c. So if c, less
and more both together, is cut to the same number, that is its result too; it is not in three of a
thousand lanes near x = 0, and in all beyond e^x = 2^13. What is lost here, in units of 2^−52n, with
n ≤ 8: ρ is within 2, and u = 2^12 ρ within 2^13; the series' terms lose 2n + 2 each, forty of them
at most, and what is left out is less; with the product by u, that loses 2n, and divided by 2^12
this leaves less than 8 of 1 − e^−ρ. The table's value, half of 2^(i/2^12), is within 1, and the
product with it loses 2n: in all less than 2 n + 16. What one orbit's function loses follows from
the same count: e^ρ − 1 is within 6 units of 2^−W, the table's value within ½ of 2^(2 − W), and the
product loses 2 m + 3: less than `lost_by_one`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from math import factorial

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.fractions import (
    Fractions,
    Reduction,
    Table,
    add,
    constant,
    negate,
    rows_of,
    settle,
    subtract,
)
from verify.arithmetic.lanes.numbers import FunctionValues, Numbers
from verify.arithmetic.lanes.products import LaneNumber
from verify.arithmetic.lanes.vectors import CONDITIONS, DIGIT, LANES, WORDS, splat, splat_double
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.limbs import constant as word
from verify.arithmetic.wide.size import width_of
from verify.arithmetic.wide.table_series import arb_integer

_ANGLES = 1 << 14  # table steps of a full turn
_QUARTER = _ANGLES // 4
_SHIFT = 12  # |r| < 2^−12
_OCTAVE = 1 << 12  # table steps of a factor 2
_SHIFT_OF_REST = 12  # ρ < 2^−12
_MARGIN = 2.0**-20  # of k, so that ρ is surely not negative
_MOST, _LEAST = 12, -47  # of a, beyond which one orbit's function is asked


def lost_by_one(fraction: int) -> int:
    """Return the units of 2^(2 − W) that one orbit's function loses at most before it rounds."""
    return 4 * (width_of(fraction) // 64) + 16


def lost_in_units(fraction: int, count: int, place: int) -> int:
    """Return `lost_by_one` units of 2^(place − W) in those of 2^−52·count, or a little more."""
    lost, shift = lost_by_one(fraction), place + DIGIT * count - width_of(fraction)
    return lost << shift if shift >= 0 else -(-lost >> -shift)


def _lost_of_circle(count: int) -> int:
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

    def cos_sin(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return cos x and sin x."""
        # k in float64 may be off by one if x/step is near a half-integer: r is then a little
        # above half a step, which the bound of |r| allows for.
        near = self.reduction.steps(b, x)
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "rint"), [near]), WORDS)
        r = self.reduction.rest(b, x, k)
        negative = b.icmp_signed("<", r[-1], splat(0))
        sine, versine = self._small(b, settle(b, negate(b, negative, r)))
        rows = vectors.lanes_of(b, b.and_(k, splat(_QUARTER - 1)))
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
            [b.select(odd, u, v) for u, v in zip(if_odd, if_even, strict=True)]
            for if_odd, if_even in ((sin, cos), (cos, sin))
        )
        cos_x = self._round(b, negate(b, b.xor(odd, half), cos))
        sin_x = self._round(b, negate(b, half, sin))
        return FunctionValues(
            [*cos_x.values, *sin_x.values], unsure=b.or_(cos_x.unsure, sin_x.unsure)
        )

    def _small(self, b: ir.IRBuilder, size: Sequence[Value]) -> tuple[list[Value], list[Value]]:
        """Return sin |r| and 1 − cos |r|."""
        fractions = self.fractions
        u = fractions.shift_up(b, size, _SHIFT)
        t = settle(b, fractions.product(b, u, u))
        many = range(8 * self.count)
        coefficients = ([Fraction(1, factorial(2 * j + k)) for j in many] for k in (1, 2))
        by_u, by_t = fractions.series(b, t, *coefficients, shift=2 * _SHIFT)
        sine = fractions.shift_down(b, settle(b, fractions.product(b, u, by_u)), _SHIFT)
        versine = fractions.shift_down(b, settle(b, fractions.product(b, t, by_t)), 2 * _SHIFT)
        return sine, versine

    def _sines(self) -> Table:
        if self._table is None:
            rows = _sines_of(self.count)
            self._table = Table(self.module, "lanes_sines", rows, self.count)
        return self._table

    def _round(self, b: ir.IRBuilder, value: Sequence[Value]) -> FunctionValues:
        """Return the number of a fraction with its sign."""
        total = settle(b, add(b, value, constant(1 << (self.spare - 1), self.count)))
        lost = _lost_of_circle(self.count) + lost_in_units(self.numbers.fraction, self.count, 2)
        rest = b.and_(b.add(total[0], splat(lost)), splat((1 << self.spare) - 1))
        unsure = b.icmp_unsigned("<", rest, splat(2 * lost))
        limbs = self.fractions.shift_down(b, total, self.spare)
        return FunctionValues([self.numbers.from_settled(limbs, self.numbers.size)], unsure=unsure)


def _lost_of_exponential(count: int) -> int:
    return 2 * count + 16


@cache
def _powers_of(count: int) -> ir.Constant:
    """Return half of 2^(i/_OCTAVE), the same in all modules."""
    with working_precision(DIGIT * count + 256):
        step = flint.arb(2).log() / _OCTAVE
        values = [arb_integer((step * i).exp(), DIGIT * count - 1) for i in range(_OCTAVE)]
    return rows_of(values, count)


class Exponential:
    """exp, sinh and cosh for numbers of one format."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers = module, numbers
        self.reduction = Reduction(numbers, lambda: flint.arb(2).log() / _OCTAVE)
        self.count, self.below = self.reduction.count, DIGIT * self.reduction.count - numbers.size
        self.fractions = Fractions(numbers.multiply_add, self.count)
        self._table: Table | None = None

    def exp(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return e^x."""
        k, rho = self._reduce(b, x)
        half = self._powers().entries(b, vectors.lanes_of(b, b.and_(k, splat(_OCTAVE - 1))))
        mantissa = subtract(b, half, self.fractions.product(b, half, self._small(b, rho)))
        a = vectors.down(b, k, _OCTAVE.bit_length() - 1)
        # Of m, which is half of one orbit's mantissa.
        lost = _lost_of_exponential(self.count) + lost_in_units(
            self.numbers.fraction, self.count, 1
        )
        # The number is 2^(F + 16) m / 2^(15 − a); if that is no shift from 1 to 63, one orbit is
        # asked.
        in_range = b.and_(
            b.icmp_signed("<=", a, splat(_MOST)), b.icmp_signed(">=", a, splat(_LEAST))
        )
        shift = b.select(in_range, b.sub(splat(15), a), splat(1))
        margin = constant(lost, self.count)
        # The mantissa minus and plus all that was lost on both sides: if both are cut to one
        # number, so is the one of a single orbit.
        low, high = (
            self._cut(b, settle(b, move(b, mantissa, margin)), shift) for move in (subtract, add)
        )
        difference = splat(0)
        for u, v in zip(low.limbs, high.limbs, strict=True):
            difference = b.or_(difference, b.xor(u, v))
        unsure = b.or_(b.not_(in_range), b.icmp_unsigned("!=", difference, splat(0)))
        return FunctionValues([low], unsure=unsure)

    def cosh(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return (e^x + e^−x)/2, rounded down."""
        return self._half(b, x, self.numbers.add)

    def sinh(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return (e^x − e^−x)/2, rounded down."""
        return self._half(b, x, self.numbers.sub)

    def _half(
        self, b: ir.IRBuilder, x: LaneNumber, combine: Callable[..., LaneNumber]
    ) -> FunctionValues:
        """Return half of the sum, or of the difference, of e^x and e^−x."""
        up = self.exp(b, x)
        down = self.exp(b, self.numbers.neg(b, x))
        unsure = b.or_(up.unsure, down.unsure)
        total = combine(b, *up.values, *down.values)
        return FunctionValues([self.numbers.shift_down(b, total, splat(1))], unsure=unsure)

    def _reduce(self, b: ir.IRBuilder, x: LaneNumber) -> tuple[Value, list[Value]]:
        """Return (k, ρ), all limbs of ρ without a sign."""
        near = b.fadd(self.reduction.steps(b, x), splat_double(_MARGIN))
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "ceil"), [near]), WORDS)
        everywhere = ir.Constant(CONDITIONS, [1] * LANES)
        return k, settle(b, negate(b, everywhere, self.reduction.rest(b, x, k)))

    def _small(self, b: ir.IRBuilder, rho: list[Value]) -> list[Value]:
        """Return 1 − e^−ρ."""
        fractions = self.fractions
        u = fractions.shift_up(b, rho, _SHIFT_OF_REST)
        coefficients = [Fraction(1, factorial(j + 1)) for j in range(8 * self.count)]
        (series,) = fractions.series(b, u, coefficients, shift=_SHIFT_OF_REST)
        return fractions.shift_down(b, settle(b, fractions.product(b, u, series)), _SHIFT_OF_REST)

    def _cut(self, b: ir.IRBuilder, mantissa: list[Value], shift: Value) -> LaneNumber:
        """Return 2^(F + 16) m / 2^shift, rounded down."""
        if self.below:
            mantissa = self.fractions.shift_down(b, mantissa, self.below)
        return self.numbers.shift_down(
            b, self.numbers.from_settled(mantissa, self.numbers.size), shift
        )

    def _powers(self) -> Table:
        if self._table is None:
            rows = _powers_of(self.count)
            self._table = Table(self.module, "lanes_powers", rows, self.count)
        return self._table
