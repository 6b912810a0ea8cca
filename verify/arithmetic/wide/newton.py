"""log, sqrt and 1/x of fixed-point numbers as LLVM functions, and functions composed of others.

log x is ℓ + log(1 + δ), with the logarithm ℓ of float64 and δ = x e^−ℓ − 1 below 2^−44. sqrt and
1/x are Newton's iteration from the value of float64. A composed function is computed in finer
numbers, with 64 bits more after the point: their errors are far below the last place of the result,
which is rounded once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import I64, Value, constant, resize
from verify.arithmetic.wide.size import INTEGER_BITS, WORD, size_of, width_of
from verify.arithmetic.wide.table_series import Functions, arb_integer
from verify.functions import by_name

FINER_BITS = WORD  # additional bits after the point of the finer numbers
DOUBLE = ir.DoubleType()
# sqrt is defined for x ≥ 2^−26, and 1/x for |x| ≥ 2^−14: their slopes are in range there.
LEAST_ROOT_PLACES = 26
LEAST_DIVISOR_PLACES = 14


def to_double(b: ir.IRBuilder, x: Value, fraction: int) -> Value:
    """Return the number x as float64, from its leading 128 bits.

    The error is below 2^−52 |x| + 2^−100; for a sum, whose leading bits stand for 2^64 times as
    much, below 2^−52 |x| + 2^−36.
    """
    more = limbs.extra_integer_bits(x, fraction)
    high = b.sitofp(limbs.leading(b, x, fraction), DOUBLE)
    low = b.uitofp(limbs.leading(b, x, fraction, 1), DOUBLE)
    unit, below = (ir.Constant(DOUBLE, x) for x in units_of_words(more))
    return b.fadd(b.fmul(high, unit), b.fmul(low, below))


def units_of_words(more: int) -> tuple[float, float]:
    """Return the units of a number's two leading words, for a number with `more` additional bits
    before the point."""
    return 2.0 ** (INTEGER_BITS + more - 64), 2.0 ** (INTEGER_BITS + more - 128)


def from_double(b: ir.IRBuilder, value: Value, fraction: int) -> Value:
    """Return a float64 as a number; bits below 2^−fraction are cut.

    |value| must be below 2^15.
    """
    floor = b.module.declare_intrinsic("llvm.floor", [DOUBLE])
    absolute = b.module.declare_intrinsic("llvm.fabs", [DOUBLE])
    width = width_of(fraction)
    # The size is converted, and then its sign applied: by how much a small negative number is above
    # −1 would not be a float64.
    rest = b.fmul(b.call(absolute, [value]), ir.Constant(DOUBLE, 2.0 ** (fraction - width + 64)))
    total = constant(0, width)
    for i in reversed(range(width // 64)):
        integer = b.call(floor, [rest])
        part = resize(b, b.fptoui(integer, I64), width)
        total = b.or_(total, limbs.shifted_up(b, part, 64 * i))
        rest = b.fmul(b.fsub(rest, integer), ir.Constant(DOUBLE, 2.0**64))
    negative = b.fcmp_ordered("<", value, ir.Constant(DOUBLE, 0.0))
    return b.select(negative, b.neg(total), total)


def iterations(fraction: int, *, quadratic: bool) -> int:
    """Return the number of iterations from an error of 2^−48 to one 16 bits below the last bit;
    each doubles the right bits (`quadratic`), or adds 48."""
    done, steps = 48, 0
    while done < size_of(fraction):
        done = 2 * done if quadratic else done + 48
        steps += 1
    return steps


@dataclass
class FinerNumber:
    """A number of the finer format, with the operators + and *."""

    numbers: "FinerNumbers"
    value: Value

    def __add__(self, other: "FinerNumber") -> "FinerNumber":
        return FinerNumber(self.numbers, self.numbers.b.add(self.value, other.value))

    def __mul__(self, other: "FinerNumber") -> "FinerNumber":
        product = self.numbers.functions.products.product
        return FinerNumber(self.numbers, product(self.numbers.b, self.value, other.value))


class FinerNumbers:
    """The finer numbers in which a function is composed (see
    `verify.functions.function.FixedPoint`).

    `valid`: the condition that every function applied so far has a value.
    """

    def __init__(self, b: ir.IRBuilder, functions: Functions) -> None:
        self.b, self.functions = b, functions
        self.valid = ir.Constant(ir.IntType(1), 1)

    @property
    def one(self) -> FinerNumber:
        return FinerNumber(self, constant(1 << self.functions.fraction, self.functions.width))

    def apply(self, name: str, x: FinerNumber) -> FinerNumber:
        """Apply the function of that name."""
        packed = self.b.call(self.functions.get(name), [x.value])
        self.valid = self.b.and_(self.valid, self.b.extract_value(packed, 1))
        return FinerNumber(self, self.b.extract_value(packed, 0))

    def absolute(self, x: FinerNumber) -> FinerNumber:
        """Return |x|; the least number has no absolute value, and makes `valid` false."""
        size, functions = self.signed(x, x), self.functions
        limit = constant(1 << functions.fraction + INTEGER_BITS - 1, functions.width)
        self.valid = self.b.and_(self.valid, self.b.icmp_unsigned("<", size.value, limit))
        return size

    def signed(self, size: FinerNumber, like: FinerNumber) -> FinerNumber:
        """Return −size if `like` is negative, else size."""
        negative = self.b.icmp_signed("<", like.value, constant(0, self.functions.width))
        return self.choose(negative, FinerNumber(self, self.b.neg(size.value)), size)

    def at_least(self, x: FinerNumber, least: FinerNumber) -> Value:
        """Return the condition x ≥ least."""
        return self.b.icmp_signed(">=", x.value, least.value)

    def choose(self, condition: Value, x: FinerNumber, y: FinerNumber) -> FinerNumber:
        """Return x if the condition holds, else y."""
        return FinerNumber(self, self.b.select(condition, x.value, y.value))


class MoreFunctions(Functions):
    """A writer of all functions in fixed point: those of `Functions`, those computed by iteration,
    and those composed of others."""

    def get(self, name: str) -> ir.Function:
        function = by_name().get(name)
        rule = function.fixed.composed if function and function.fixed else None
        if rule is not None and name not in self._made:
            self._made[name] = self._compose(name, rule)
        return super().get(name)

    @cached_property
    def _finer(self) -> "MoreFunctions":
        return MoreFunctions(self.module, self.fraction + FINER_BITS, "finer")

    def _compose(
        self, name: str, rule: Callable[[FinerNumbers, FinerNumber], FinerNumber]
    ) -> ir.Function:
        """Return the function that evaluates `rule` in finer numbers and rounds to the nearest."""
        b, x = self._define(name, 1)
        finer, width = FinerNumbers(b, self._finer), self._finer.width
        widened = limbs.shifted_up(b, resize(b, x, width, signed=True), FINER_BITS)
        total = b.add(
            rule(finer, FinerNumber(finer, widened)).value, constant(1 << FINER_BITS - 1, width)
        )
        value = resize(b, b.ashr(total, constant(FINER_BITS, width)), self.width)
        return self._result(b, finer.valid, value)

    def _inverse(self) -> ir.Function:
        b, x = self._define("inverse", 1)
        size = self._copy_sign(b, x, x)
        valid = b.icmp_unsigned(">=", size, self._power(-LEAST_DIVISOR_PLACES))
        one = ir.Constant(DOUBLE, 1.0)
        # An x out of range is replaced by 1, so that no infinity is converted to an integer.
        guess = b.fdiv(one, b.select(valid, to_double(b, x, self.fraction), one))
        y = from_double(b, guess, self.fraction)
        product = self.products.product
        # y ← y + y (1 − x y): the relative error is squared each time.
        for _ in range(iterations(self.fraction, quadratic=True)):
            error = b.sub(self._power(0), product(b, x, y))
            y = b.add(y, product(b, y, error))
        return self._result(b, valid, y)

    def _sqrt(self) -> ir.Function:
        b, x = self._define("sqrt", 1)
        valid = b.icmp_signed(">=", x, self._power(-LEAST_ROOT_PLACES))
        root = self.module.declare_intrinsic("llvm.sqrt", [DOUBLE])
        one = ir.Constant(DOUBLE, 1.0)
        guess = b.call(root, [b.select(valid, to_double(b, x, self.fraction), one)])
        half = b.fdiv(ir.Constant(DOUBLE, 0.5), guess)
        s = from_double(b, guess, self.fraction)
        slope = from_double(b, half, self.fraction)
        product = self.products.product
        # s ← s + (x − s²)/(2 s₀): the slope stays that of the guess, which saves a division.
        for _ in range(iterations(self.fraction, quadratic=False)):
            s = b.add(s, product(b, b.sub(x, product(b, s, s)), slope))
        return self._result(b, valid, s)

    def _log(self) -> ir.Function:
        """Define log x = log m + e·ln 2 with x = m·2^e, m in [½, 1)."""
        b, x = self._define("log", 1)
        width, places = self.width, self.width - 2
        valid = b.icmp_signed(">", x, constant(0, width))
        # The leading zeros are shifted out: m in [½, 1) as a fraction of `width` bits.
        x = b.select(valid, x, constant(1, width))
        lead = b.ctlz(x, ir.Constant(ir.IntType(1), 0))
        m = b.shl(x, lead)
        near = b.uitofp(limbs.limb(b, m, self.count - 1), DOUBLE)
        logarithm = self.module.declare_intrinsic("llvm.log", [DOUBLE])
        guess = b.call(logarithm, [b.fmul(near, ir.Constant(DOUBLE, 2.0**-64))])
        minus = from_double(b, b.fneg(guess), self.fraction)
        mantissa, a = self._exponential(b, minus)
        # e^−guess is m·2^a, with a = 1 near guess = −ln 2, and a = −1 near guess = 0.
        below = b.icmp_signed("<", a, constant(0, 64))
        doubled = b.shl(mantissa, resize(b, b.select(below, constant(0, 64), a), width))
        power = b.select(below, limbs.shifted_down(b, mantissa, 1), doubled)
        # δ = m e^−guess − 1 is small: log m = guess + log(1 + δ).
        delta = b.sub(self.products.high(b, m, power), constant(1 << places, width))
        total = b.add(b.neg(b.shl(minus, constant(self.spare - 2, width))), self._log1p(b, delta))
        # e·ln 2 may be larger than a fraction can be: the sum has one limb more.
        wide = width + 64
        with working_precision(width + 128):
            two = constant(arb_integer(flint.arb(2).log(), places + 32), wide)
        exponent = b.sub(constant(self.spare, wide), resize(b, lead, wide))
        octaves = b.ashr(b.mul(exponent, two), constant(32, wide))
        total = b.add(resize(b, total, wide, signed=True), octaves)
        shift = self.spare - 2
        total = b.ashr(b.add(total, constant(1 << (shift - 1), wide)), constant(shift, wide))
        return self._result(b, valid, resize(b, total, width))

    def _log1p(self, b: ir.IRBuilder, delta: Value) -> Value:
        """Return log(1 + δ) by its series, for |δ| < 2^−44; both have W − 2 fraction bits."""
        width, places, high = self.width, self.width - 2, self.products.high
        stretched = limbs.shifted_up(b, delta, 40)
        terms = -(-width // 44)
        total = constant((1 << places) // terms, width)
        for j in reversed(range(1, terms)):
            # (δ 2^(W+38)) (s 2^(W−2)) / 2^W = δ s 2^(W+36)
            part = b.ashr(high(b, stretched, total, signed=True), constant(38, width))
            total = b.sub(constant((1 << places) // j, width), part)
        return b.ashr(high(b, stretched, total, signed=True), constant(38, width))
