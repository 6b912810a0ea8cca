"""sin, cos, exp, sinh and cosh in lanes, with the bits of `verify.arithmetic.wide.table_series`.

Values are fractions of n limbs of 52 bits, with the unit 2^(−52 n). The functions of one orbit
compute with W bits in m words of 64. Each function here says in which lanes its last bit is unsure;
there the function of one orbit is called. “a is within e” means: the error of a is below e.

sin and cos: x = k·2π/2^14 + r; sin and cos of the first term come from a table of a quarter turn,
those of |r| ≤ π/2^14 from Taylor polynomials. The error of one orbit's function before it rounds is
at most `error_of_one_orbit` units of 2^(2 − W), that of this one at most `_circle_error` units. So
if the value is farther from a rounding boundary than both errors together, both functions round
alike; in one of a hundred lanes it is not. The errors here, in units, with n ≤ 20: r is within 2;
t = u² with u = 2^12 |r| within 2^13·2 + 2n; each term of the series adds 2n + 2, for twenty terms
at most, and the omitted terms less; divided by 2^12 and by 2^24 this leaves less than 8 in sin r
and in 1 − cos r. The products with the table's values, which are within 1, add 2n + 9 each: in all
less than 4 n + 40. The same count for one orbit's function: r within 2 units of 2^−W, sin r and
1 − cos r within 8, table values within ½ unit of 2^(2 − W), two products that add 2 m + 3 each:
less than 4 m + 16 units of 2^(2 − W).

exp: x = k·ln 2/2^12 − ρ with 0 ≤ ρ < 2^−12; 2^(i/2^12), i = k mod 2^12, comes from a table, and
1 − e^−ρ = ρ (1 − ρ/2 + ρ²/6 − …) from its series; so e^x = c·2^a with c from ½ to 1. One orbit's
function has an error of at most `error_of_one_orbit` units of 2^(2 − W) in 2 c, before it cuts the
bits below a number's last; this one has at most `_exponential_error` units in c. So if c minus and
c plus both errors are cut to the same number, it is also the result for one orbit; that fails in
three of a thousand lanes near x = 0, and in all lanes beyond e^x = 2^13. The errors here, in units,
with n ≤ 8: ρ is within 2, and u = 2^12 ρ within 2^13; each term of the series adds 2n + 2, for
forty terms at most, and the omitted terms less; with the product by u, which adds 2n, and divided
by 2^12, this leaves less than 8 in 1 − e^−ρ. The table's value, half of 2^(i/2^12), is within 1,
and the product with it adds 2n: in all less than 2 n + 16. The same count for one orbit's function:
e^ρ − 1 is within 6 units of 2^−W, the table's value within ½ of 2^(2 − W), and the product adds
2 m + 3: less than `error_of_one_orbit`.
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
from verify.arithmetic.lanes.vectors import CONDITIONS, LANES, LIMB_BITS, WORDS, splat, splat_double
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.limbs import constant as word
from verify.arithmetic.wide.size import width_of
from verify.arithmetic.wide.table_series import arb_integer

_STEPS_PER_TURN = 1 << 14  # table steps
_STEPS_PER_QUARTER = _STEPS_PER_TURN // 4
_ANGLE_SHIFT = 12  # |r| < 2^−12
_STEPS_PER_OCTAVE = 1 << 12  # table steps of a factor 2
_REST_SHIFT = 12  # ρ < 2^−12
_CEILING_MARGIN = 2.0**-20  # is added to x/step before k is rounded up, so that ρ is never negative
_MAX_EXPONENT, _MIN_EXPONENT = 12, -47  # for an a outside, the function of one orbit is called


def error_of_one_orbit(fraction: int) -> int:
    """Return a bound on the error of one orbit's function before it rounds, in units of
    2^(2 − W)."""
    return 4 * (width_of(fraction) // 64) + 16


def error_in_units(fraction: int, count: int, place: int) -> int:
    """Return `error_of_one_orbit`, taken in units of 2^(place − W), in units of 2^(−52 count),
    rounded up."""
    error, shift = error_of_one_orbit(fraction), place + LIMB_BITS * count - width_of(fraction)
    return error << shift if shift >= 0 else -(-error >> -shift)


def _circle_error(count: int) -> int:
    return 4 * count + 40


@cache
def _sines_of(count: int) -> ir.Constant:
    """Return the table of sin at the steps of a quarter turn; all modules share it."""
    with working_precision(LIMB_BITS * count + 256):
        step = 2 * flint.arb.pi() / _STEPS_PER_TURN
        values = [
            arb_integer((step * k).sin(), LIMB_BITS * count) for k in range(_STEPS_PER_QUARTER + 1)
        ]
    return rows_of(values, count)


class Circle:
    """sin and cos for numbers of one format."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers = module, numbers
        self.reduction = Reduction(numbers, lambda: 2 * flint.arb.pi() / _STEPS_PER_TURN)
        self.count, self.spare = self.reduction.count, self.reduction.spare
        self._table: Table | None = None
        self.fractions = Fractions(numbers.multiply_add, self.count)

    def cos_sin(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return cos x and sin x."""
        # k in float64 may be off by one if x/step is near a half-integer: |r| is then a little
        # above half a step, which the bound on |r| allows for.
        near = self.reduction.steps(b, x)
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "rint"), [near]), WORDS)
        r = self.reduction.rest(b, x, k)
        negative = b.icmp_signed("<", r[-1], splat(0))
        sine, versine = self._small(b, settle(b, negate(b, negative, r)))
        rows = vectors.lanes_of(b, b.and_(k, splat(_STEPS_PER_QUARTER - 1)))
        s = self._sines().entries(b, rows)
        c = self._sines().entries(b, [b.sub(word(_STEPS_PER_QUARTER, 64), row) for row in rows])
        product = self.fractions.product
        along = negate(b, negative, product(b, c, sine))
        across = negate(b, negative, product(b, s, sine))
        sin = add(b, subtract(b, s, product(b, s, versine)), along)
        cos = subtract(b, subtract(b, c, product(b, c, versine)), across)
        # After a quarter turn cos becomes −sin and sin becomes cos; after two both change signs.
        odd = b.icmp_unsigned("!=", b.and_(k, splat(_STEPS_PER_QUARTER)), splat(0))
        half = b.icmp_unsigned("!=", b.and_(k, splat(2 * _STEPS_PER_QUARTER)), splat(0))
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
        u = fractions.shift_up(b, size, _ANGLE_SHIFT)
        t = settle(b, fractions.product(b, u, u))
        many = range(8 * self.count)
        coefficients = ([Fraction(1, factorial(2 * j + k)) for j in many] for k in (1, 2))
        by_u, by_t = fractions.series(b, t, *coefficients, shift=2 * _ANGLE_SHIFT)
        sine = fractions.shift_down(b, settle(b, fractions.product(b, u, by_u)), _ANGLE_SHIFT)
        versine = fractions.shift_down(
            b, settle(b, fractions.product(b, t, by_t)), 2 * _ANGLE_SHIFT
        )
        return sine, versine

    def _sines(self) -> Table:
        if self._table is None:
            rows = _sines_of(self.count)
            self._table = Table(self.module, "lanes_sines", rows, self.count)
        return self._table

    def _round(self, b: ir.IRBuilder, value: Sequence[Value]) -> FunctionValues:
        """Return a fraction with a sign, rounded to a number."""
        total = settle(b, add(b, value, constant(1 << (self.spare - 1), self.count)))
        error = _circle_error(self.count) + error_in_units(self.numbers.fraction, self.count, 2)
        rest = b.and_(b.add(total[0], splat(error)), splat((1 << self.spare) - 1))
        unsure = b.icmp_unsigned("<", rest, splat(2 * error))
        limbs = self.fractions.shift_down(b, total, self.spare)
        return FunctionValues([self.numbers.from_settled(limbs, self.numbers.size)], unsure=unsure)


def _exponential_error(count: int) -> int:
    return 2 * count + 16


@cache
def _powers_of(count: int) -> ir.Constant:
    """Return the table of 2^(i/_STEPS_PER_OCTAVE)/2; all modules share it."""
    with working_precision(LIMB_BITS * count + 256):
        step = flint.arb(2).log() / _STEPS_PER_OCTAVE
        values = [
            arb_integer((step * i).exp(), LIMB_BITS * count - 1) for i in range(_STEPS_PER_OCTAVE)
        ]
    return rows_of(values, count)


class Exponential:
    """exp, sinh and cosh for numbers of one format."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers = module, numbers
        self.reduction = Reduction(numbers, lambda: flint.arb(2).log() / _STEPS_PER_OCTAVE)
        self.count, self.below = (
            self.reduction.count,
            LIMB_BITS * self.reduction.count - numbers.size,
        )
        self.fractions = Fractions(numbers.multiply_add, self.count)
        self._table: Table | None = None

    def exp(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Return e^x."""
        k, rho = self._reduce(b, x)
        half = self._powers().entries(
            b, vectors.lanes_of(b, b.and_(k, splat(_STEPS_PER_OCTAVE - 1)))
        )
        mantissa = subtract(b, half, self.fractions.product(b, half, self._small(b, rho)))
        a = vectors.down(b, k, _STEPS_PER_OCTAVE.bit_length() - 1)
        # The mantissa is half of one orbit's, hence the place 1 in place of 2.
        error = _exponential_error(self.count) + error_in_units(
            self.numbers.fraction, self.count, 1
        )
        # The number is 2^(F + 16) mantissa / 2^(15 − a); if the shift is not from 1 to 63, the
        # function of one orbit is called.
        in_range = b.and_(
            b.icmp_signed("<=", a, splat(_MAX_EXPONENT)),
            b.icmp_signed(">=", a, splat(_MIN_EXPONENT)),
        )
        shift = b.select(in_range, b.sub(splat(15), a), splat(1))
        margin = constant(error, self.count)
        # The mantissa minus and plus both errors: if they are cut to the same number, so is the
        # mantissa of one orbit.
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
        """Return half of the sum or difference (`combine`) of e^x and e^−x."""
        up = self.exp(b, x)
        down = self.exp(b, self.numbers.neg(b, x))
        unsure = b.or_(up.unsure, down.unsure)
        total = combine(b, *up.values, *down.values)
        return FunctionValues([self.numbers.shift_down(b, total, splat(1))], unsure=unsure)

    def _reduce(self, b: ir.IRBuilder, x: LaneNumber) -> tuple[Value, list[Value]]:
        """Return (k, ρ); the limbs of ρ are not negative."""
        near = b.fadd(self.reduction.steps(b, x), splat_double(_CEILING_MARGIN))
        k = b.fptosi(b.call(vectors.intrinsic(self.module, "ceil"), [near]), WORDS)
        everywhere = ir.Constant(CONDITIONS, [1] * LANES)
        return k, settle(b, negate(b, everywhere, self.reduction.rest(b, x, k)))

    def _small(self, b: ir.IRBuilder, rho: list[Value]) -> list[Value]:
        """Return 1 − e^−ρ."""
        fractions = self.fractions
        u = fractions.shift_up(b, rho, _REST_SHIFT)
        coefficients = [Fraction(1, factorial(j + 1)) for j in range(8 * self.count)]
        (series,) = fractions.series(b, u, coefficients, shift=_REST_SHIFT)
        return fractions.shift_down(b, settle(b, fractions.product(b, u, series)), _REST_SHIFT)

    def _cut(self, b: ir.IRBuilder, mantissa: list[Value], shift: Value) -> LaneNumber:
        """Return 2^(F + 16) mantissa / 2^shift, rounded down."""
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
