"""sin, cos, exp, sinh and cosh of fixed-point numbers as LLVM functions, by tables and series.

A number has F fraction bits and 16 integer bits, the sign among them, in W = 64 n bits; its unit is
2^−F. The functions compute with fractions of W bits, or with mantissas of W − 2 fraction bits: the
errors of products stay far below one unit. Each function's file in `verify.functions` has a bound
on its error.

sin and cos: x = k·2π/2^14 + r; sin and cos of the first term come from a table, those of
|r| ≤ π/2^14 from Taylor polynomials. exp: x = k·ln 2/2^12 + r likewise. The leading limbs of a high
term of a polynomial are zero, and are not computed. The even terms are one polynomial and the odd
terms another, which are computed side by side.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from math import factorial

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import I64, Value, bits, constant, resize
from verify.arithmetic.wide.products import ProductWriter
from verify.arithmetic.wide.size import INTEGER_BITS, WORD, width_of

_STEPS_PER_TURN = 1 << 14  # table steps
_STEPS_PER_QUARTER = _STEPS_PER_TURN // 4
_STEPS_PER_OCTAVE = 1 << 12  # table steps for a factor 2
_STRETCH_BITS = 12  # r, at most half a step of a turn or a step of an octave, is below 2^−12
_POSITIVE_OFFSET = 1 << 28  # table steps, a multiple of turns and of octaves, added to make k ≥ 0
_NEGLIGIBLE_UNITS = 32  # units 2^−W of a fraction; smaller coefficients are left out


def arb_integer(value: flint.arb, shift: int) -> int:
    """Return an arb's midpoint times 2^shift, rounded to the nearest integer."""
    mantissa, exponent = map(int, value.mid().man_exp())
    power = exponent + shift
    return mantissa << power if power >= 0 else round(Fraction(mantissa, 1 << -power))


def _table_of(values: Sequence[int], width: int) -> ir.Constant:
    """Return a table of integers of `width` bits: the limbs of each, the lowest first."""
    return limbs.words([(v >> 64 * i) & (2**64 - 1) for v in values for i in range(width // 64)])


def _negate(b: ir.IRBuilder, condition: Value, x: Value) -> Value:
    """Return −x if the condition holds, else x."""
    mask = b.sext(condition, x.type)
    return b.sub(b.xor(x, mask), mask)


# The tables of a width are the same in all modules; they take longer to compute than to compile.


@cache
def _sines(width: int) -> ir.Constant:
    """Return the table of sin at the steps of a quarter turn, with W − 2 fraction bits."""
    with working_precision(width + 128):
        unit = 2 * flint.arb.pi() / _STEPS_PER_TURN
        values = [arb_integer((unit * k).sin(), width - 2) for k in range(_STEPS_PER_QUARTER + 1)]
    return _table_of(values, width)


@cache
def _powers(width: int) -> ir.Constant:
    """Return the table of 2^(k/_STEPS_PER_OCTAVE) with W − 2 fraction bits."""
    with working_precision(width + 128):
        unit = flint.arb(2).log() / _STEPS_PER_OCTAVE
        values = [arb_integer((unit * k).exp(), width - 2) for k in range(_STEPS_PER_OCTAVE)]
    return _table_of(values, width)


class Functions:
    """A writer of the functions of one format into a module; each is written when it is first used.

    `spare`: the bits of W before the point. `label`: the prefix of the functions' names, one for
    each format of a module.
    """

    def __init__(self, module: ir.Module, fraction: int, label: str = "fixed") -> None:
        self.module, self.fraction, self.width = module, fraction, width_of(fraction)
        self.label = label
        self.count, self.spare = self.width // 64, self.width - fraction
        self.type = bits(self.width)
        self.products = ProductWriter(module, fraction)
        self._made: dict[str, ir.Function] = {}
        self._tables: dict[str, ir.GlobalVariable] = {}

    def get(self, name: str) -> ir.Function:
        """Return the function of that name; it returns (value, …, valid)."""
        if name not in self._made:
            self._made[name] = getattr(self, f"_{name}")()
        return self._made[name]

    # -- helpers ------------------------------------------------------------------------------

    def _define(self, name: str, results: int) -> tuple[ir.IRBuilder, Value]:
        """Begin a function of one number, which returns `results` numbers and whether they are
        valid; return its builder and its argument."""
        kind = ir.LiteralStructType([self.type] * results + [ir.IntType(1)])
        function = ir.Function(
            self.module, ir.FunctionType(kind, [self.type]), f"{self.label}_{name}"
        )
        function.linkage = "internal"
        return ir.IRBuilder(function.append_basic_block("entry")), function.args[0]

    def _result(self, b: ir.IRBuilder, valid: Value, *values: Value) -> ir.Function:
        packed = ir.Constant(b.function.function_type.return_type, ir.Undefined)
        for index, value in enumerate((*values, valid)):
            packed = b.insert_value(packed, value, index)
        b.ret(packed)
        return b.function

    def _table(self, name: str, values: ir.Constant) -> ir.GlobalVariable:
        table = ir.GlobalVariable(self.module, values.type, f"{self.label}_{name}")
        table.linkage, table.global_constant = "internal", True
        table.initializer = values
        return table

    def _entry(self, b: ir.IRBuilder, table: ir.GlobalVariable, index: Value) -> Value:
        value = constant(0, self.width)
        first = b.mul(index, constant(self.count, 64))
        for i in range(self.count):
            at = b.gep(table, [constant(0, 64), b.add(first, constant(i, 64))], inbounds=True)
            part = resize(b, b.load(at, typ=I64), self.width)
            value = b.or_(value, limbs.shifted_up(b, part, 64 * i))
        return value

    def _multiple(
        self, b: ir.IRBuilder, x: Value, unit: flint.arb, offset: Fraction
    ) -> tuple[Value, Value]:
        """Return (k, r) with x = k·unit + r; k is the floor of x/unit + offset, as i64, and r has W
        fraction bits.

        k comes from the leading bits alone: it is the floor of a number within 2^−18 of
        x/unit + offset, or within 2^−28 if |x| < 16. The error of k·unit is at most a unit of r.
        The product is formed of k + 2^28, which is not negative: |x| < 2^15 and unit > 2^−13.
        """
        high = resize(b, limbs.leading(b, x, self.fraction), 128, signed=True)
        k = b.mul(high, constant(arb_integer(1 / unit, 32), 128))
        k = b.ashr(b.add(k, constant(int(offset * 2**80), 128)), constant(80, 128))
        k = b.trunc(k, I64)
        stretched = constant(arb_integer(unit, self.width + WORD), self.width + WORD)
        multiple = limbs.times_word(b, stretched, b.add(k, constant(_POSITIVE_OFFSET, WORD)))
        scaled = limbs.shifted_up(b, x, self.spare)
        start = constant(arb_integer(unit * _POSITIVE_OFFSET, self.width), self.width)
        return k, b.sub(b.add(scaled, start), resize(b, multiple, self.width))

    def _series(
        self, b: ir.IRBuilder, t: Value, series: Sequence[Sequence[Fraction]], shift: int, sign: int
    ) -> list[Value]:
        """Return c₀ + sign·c₁ τ + c₂ τ² + sign·c₃ τ³ + … for each series; t = τ·2^shift and the
        results are fractions, the c are positive and decrease fast, `sign` is ±1.

        The leading limbs of high coefficients cⱼ 2^(−j·shift), and of their sums, are zero. The
        series are summed side by side: none waits for another.
        """
        totals: list[Value] = [None] * len(series)
        for j in reversed(range(max(map(len, series)))):
            for i, coefficients in enumerate(series):
                if j >= len(coefficients):
                    continue
                scaled = round(coefficients[j] * Fraction(2) ** (self.width - j * shift))
                scaled = min(scaled, 2**self.width - 1)  # 1 becomes the largest fraction
                if scaled < _NEGLIGIBLE_UNITS:
                    continue
                size = 64 * -(-scaled.bit_length() // 64)
                value = constant(scaled, size)
                if totals[i] is not None:
                    short = limbs.top(b, t, totals[i].type.width // 64)
                    part = resize(b, self.products.high(b, short, totals[i]), size)
                    value = b.sub(value, part) if sign < 0 else b.add(value, part)
                totals[i] = value
        return totals

    def _power(self, exponent: int) -> Value:
        """Return 2^exponent as a number."""
        return constant(1 << self.fraction + exponent, self.width)

    def _copy_sign(self, b: ir.IRBuilder, magnitude: Value, like: Value) -> Value:
        """Return the magnitude with the sign of `like`."""
        return _negate(b, b.icmp_signed("<", like, constant(0, like.type.width)), magnitude)

    def _round(self, b: ir.IRBuilder, mantissa: Value) -> Value:
        """Round from W − 2 fraction bits to a number."""
        shift = self.spare - 2
        return b.ashr(
            b.add(mantissa, constant(1 << (shift - 1), self.width)), constant(shift, self.width)
        )

    # -- sin and cos --------------------------------------------------------------------------

    def _cos_sin(self) -> ir.Function:
        b, x = self._define("cos_sin", 2)
        with working_precision(self.width + 128):
            k, r = self._multiple(b, x, 2 * flint.arb.pi() / _STEPS_PER_TURN, Fraction(1, 2))
        sine, versine = self._small(b, self._copy_sign(b, r, r))
        # After a quarter turn cos becomes −sin and sin becomes cos; after two both change signs.
        odd, half = (self._has(b, k, quarters * _STEPS_PER_QUARTER) for quarters in (1, 2))
        index = b.and_(k, constant(_STEPS_PER_QUARTER - 1, WORD))
        rest = b.sub(constant(_STEPS_PER_QUARTER, WORD), index)
        table = self._table("sines", _sines(self.width))
        s = self._entry(b, table, b.select(odd, rest, index))
        c = self._entry(b, table, b.select(odd, index, rest))
        high = self.products.high
        downwards = b.xor(b.icmp_signed("<", r, constant(0, self.width)), odd)
        along, across = (_negate(b, downwards, high(b, entry, sine)) for entry in (c, s))
        sin = b.add(b.sub(s, high(b, s, versine)), along)
        cos = b.sub(b.sub(c, high(b, c, versine)), across)
        sin_x = self._round(b, _negate(b, half, sin))
        cos_x = self._round(b, _negate(b, b.xor(odd, half), cos))
        return self._result(b, ir.Constant(ir.IntType(1), 1), cos_x, sin_x)

    def _small(self, b: ir.IRBuilder, r: Value) -> tuple[Value, Value]:
        """Return sin r and 1 − cos r of 0 ≤ r < 2^−12."""
        high = self.products.high
        u = limbs.shifted_up(b, r, _STRETCH_BITS)
        t = high(b, u, u)
        by_u, by_t = self._series(b, t, self._inverse_factorials(1, 2), 2 * _STRETCH_BITS, -1)
        sine, versine = high(b, u, by_u), high(b, t, by_t)
        return (
            limbs.shifted_down(b, sine, _STRETCH_BITS),
            limbs.shifted_down(b, versine, 2 * _STRETCH_BITS),
        )

    def _inverse_factorials(self, *first: int) -> list[list[Fraction]]:
        """Return for each first number k the inverse factorials of k, k + 2, k + 4, …."""
        many = range(8 * self.count)
        return [[Fraction(1, factorial(2 * j + k)) for j in many] for k in first]

    def _has(self, b: ir.IRBuilder, k: Value, bit: int) -> Value:
        return b.icmp_unsigned("!=", b.and_(k, constant(bit, WORD)), constant(0, WORD))

    def _sin(self) -> ir.Function:
        return self._one_of("cos_sin", 1)

    def _cos(self) -> ir.Function:
        return self._one_of("cos_sin", 0)

    def _one_of(self, pair: str, index: int) -> ir.Function:
        b, x = self._define(f"{pair}_{index}", 1)
        values = b.call(self.get(pair), [x])
        return self._result(b, b.extract_value(values, 2), b.extract_value(values, index))

    # -- exp, sinh and cosh ---------------------------------------------------------------------

    def _exponential(self, b: ir.IRBuilder, x: Value) -> tuple[Value, Value]:
        """Return (m, a) with e^x = m·2^a; m has W − 2 fraction bits, a is an i64.

        m is in [1, 2]; just above an x with m = 1 it may exceed 2 by 2^−28.
        """
        with working_precision(self.width + 128):
            unit = flint.arb(2).log() / _STEPS_PER_OCTAVE
            # A little less than the floor, so that r is surely not negative.
            k, r = self._multiple(b, x, unit, Fraction(-1, 2**20))
        if "powers" not in self._tables:
            self._tables["powers"] = self._table("powers", _powers(self.width))
        base = self._entry(
            b, self._tables["powers"], b.and_(k, constant(_STEPS_PER_OCTAVE - 1, WORD))
        )
        high = self.products.high
        u = limbs.shifted_up(b, r, _STRETCH_BITS)
        t = high(b, u, u)
        even, odd = self._series(b, t, self._inverse_factorials(2, 3), 2 * _STRETCH_BITS, 1)
        rest = high(b, t, b.add(even, limbs.shifted_down(b, high(b, u, odd), _STRETCH_BITS)))
        growth = b.add(r, limbs.shifted_down(b, rest, 2 * _STRETCH_BITS))  # e^r − 1
        mantissa = b.add(base, high(b, base, growth))
        return mantissa, b.ashr(k, constant(_STEPS_PER_OCTAVE.bit_length() - 1, WORD))

    def _exp(self) -> ir.Function:
        b, x = self._define("exp", 1)
        mantissa, a = self._exponential(b, x)
        shift = b.sub(constant(self.spare - 2, 64), a)
        most = constant(self.width - 1, 64)
        bounded = b.select(b.icmp_unsigned("<", shift, most), shift, most)
        value = b.lshr(mantissa, resize(b, bounded, self.width))
        fits = b.icmp_unsigned("<", value, self._power(INTEGER_BITS - 1))
        return self._result(b, b.and_(fits, b.icmp_signed(">=", shift, constant(0, 64))), value)

    def _cosh(self) -> ir.Function:
        return self._half_sum("cosh", is_difference=False)

    def _sinh(self) -> ir.Function:
        return self._half_sum("sinh", is_difference=True)

    def _half_sum(self, name: str, *, is_difference: bool) -> ir.Function:
        b, x = self._define(name, 1)
        up = b.call(self.get("exp"), [x])
        down = b.call(self.get("exp"), [b.neg(x)])
        e_up, e_down = b.extract_value(up, 0), b.extract_value(down, 0)
        total = b.sub(e_up, e_down) if is_difference else b.add(e_up, e_down)
        valid = b.and_(b.extract_value(up, 1), b.extract_value(down, 1))
        half = b.ashr(total, constant(1, self.width))
        # Each is below 2^14, so that the sum stays in range; both are 0 if −x is not in range.
        any_bits = b.or_(e_up, e_down)
        fits = b.icmp_unsigned("<", any_bits, self._power(INTEGER_BITS - 2))
        is_positive = b.icmp_unsigned("!=", any_bits, constant(0, self.width))
        return self._result(b, b.and_(valid, b.and_(fits, is_positive)), half)
