"""The functions sin and cos of float64 in lanes, with the bits that glibc returns.

glibc's results are within 0.518 units in the last place of the value, and sin x with |x| < 0.8555
within 0.548, as its source says (`s_sin.c`, since 2.28); Gladman, Innocente, Mather and Zimmermann
measured 0.516 at most (*Accuracy of Mathematical Functions*). So if the value is within 0.482 or
0.452 units of a float64, glibc returns that float64: the next one is too far off. Otherwise, for
one value in fourteen, glibc is called. With another C library, or on a processor without fused
multiply-add, the C library is called for all values.

Here x = k·π/2 + r, sin r = r + r z (−1/6 + z T), cos r = 1 + z (−1/2 + z (1/24 + z U)), with
z = r² at most 0.617. z T and z U are Taylor polynomials in float64; everything else is in pairs of
float64. The relative errors, in u = 2^−53: that of z T is 4.2 u, of which 2.1 u come from the low
part of z, which is left out, the rest from the first coefficient and the sums; z² T is at most
0.0035 of the sine. That of z U is as large; z³ U is at most 0.0005 of the cosine. The omitted terms
of the series make 0.0011 u; r, which is not below 2^−12, makes 2^−37 u, and operations on pairs as
little. Together they are less than 0.016 u for sines from ½ to 0.7072, where u of the value is at
most 0.7072 units in the last place, and less than 0.005 u elsewhere: less than 0.012 units.
"""

import os
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache, cached_property
from math import factorial
from typing import Any, NamedTuple, TypeAlias

import flint
from llvmlite import ir

from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.vectors import DOUBLES, LANES, WORDS, absolute, multiply_add, splat
from verify.arithmetic.wide.limbs import I64, Value, constant
from verify.arithmetic.wide.newton import DOUBLE
from verify.arithmetic.wide.one_orbit import BOOL, float_function
from verify.arithmetic.wide.table_series import arb_integer

NAMES = ("sin", "cos")
# Units in the last place: 0.482, or 0.452 for |x| < _NEAR_0_LIMIT, less the error of 0.012.
SURE_DISTANCE, SURE_DISTANCE_NEAR_0 = 0.47, 0.44
_NEAR_0_LIMIT = 0.8555
_MAX_ARGUMENT, _MIN_REMAINDER = 2.0**18, 2.0**-12  # the error bounds hold for these |x|, |r|
_INTEGER_SHIFTER = 1.5 * 2.0**52  # x plus this holds round(x) in its low bits
# Bits of each of the first two parts of π/2: so few that x − k·first and k·second are exact.
_PART_BITS = 33
_MANTISSA = (1 << 52) - 1
_SINE = [Fraction((-1) ** n, factorial(2 * n + 1)) for n in range(9)]
_COSINE = [Fraction((-1) ** n, factorial(2 * n)) for n in range(10)]
BySets: TypeAlias = Callable[..., Any]  # (operation of a builder and values, *values) → results
ForAll: TypeAlias = Callable[[Callable[[ir.IRBuilder], Any]], None]


class DoubleDouble(NamedTuple):
    """The number high + low, two vectors of float64 with |low| far below |high|.

    The relative error of a product, or of a sum whose first term is the larger one, is some units
    of 2^−104. `low` may be some units in the last place of `high`: code that uses `high` alone must
    allow for that.
    """

    high: Value
    low: Value


def exact_sum(b: ir.IRBuilder, x: Value, y: Value) -> DoubleDouble:
    """Return x + y for |x| ≥ |y|, exactly: the rounded sum, and the rounding error."""
    total = b.fadd(x, y)
    return DoubleDouble(total, b.fadd(b.fsub(x, total), y))


def plus(b: ir.IRBuilder, x: Value, y: DoubleDouble) -> DoubleDouble:
    """Return x + y, |x| ≥ |y|."""
    total = exact_sum(b, x, y.high)
    return DoubleDouble(total.high, b.fadd(total.low, y.low))


def times(b: ir.IRBuilder, x: DoubleDouble, y: DoubleDouble) -> DoubleDouble:
    product = b.fmul(x.high, y.high)
    rest = multiply_add(b, x.high, y.high, b.fneg(product))
    low = multiply_add(b, x.low, y.high, multiply_add(b, x.high, y.low, rest))
    return DoubleDouble(product, low)


class ReducedArgument(NamedTuple):
    """sin r and cos r of r = x − k π/2, not yet rounded; words whose low bits hold k; and the lanes
    in which the module's error bounds hold."""

    sine: DoubleDouble
    cosine: DoubleDouble
    quarter: Value
    within: Value


class NearestDouble(NamedTuple):
    """The nearest float64, and the lanes in which glibc may return another one."""

    nearest: Value
    unsure: Value


@cache
def is_available() -> bool:
    """Return True if the C library has these error bounds, and the processor has fused
    multiply-add: if each of these were a call, the library's sine would be faster."""
    try:
        name, _, version = (os.confstr("CS_GNU_LIBC_VERSION") or "").partition(" ")
        is_analysed = name == "glibc" and tuple(map(int, version.split(".")[:2])) >= (2, 28)
    except (AttributeError, ValueError, OSError):  # another library, or another system
        return False
    return is_analysed and vectors.features().get("fma", False)


@cache
def _quarter_turn() -> tuple[float, float, float]:
    """Return π/2 as a sum of three float64, the first two with `_PART_BITS` bits."""
    places = 5 * _PART_BITS
    with working_precision(2 * places):
        rest = Fraction(arb_integer(flint.arb.pi() / 2, places), 1 << places)
    parts = []
    for k in (1, 2):
        unit = 1 << k * _PART_BITS - 1
        parts.append(Fraction(int(rest * unit), unit))
        rest -= parts[-1]
    return float(parts[0]), float(parts[1]), float(rest)


class LibmCircle:
    """A writer of the functions `names` into a module, for `sets` vectors at once, and of calls to
    them."""

    def __init__(self, module: ir.Module, sets: int, names: Sequence[str]) -> None:
        assert sets * LANES <= 64  # noqa: S101 - a word has a bit for each lane
        self.module, self.sets, self.names = module, sets, names
        # The argument of the last call, and the values of all functions there.
        self._argument: Any = None
        self._values: dict[str, Any] = {}

    def apply(
        self, name: str, x: Any, allocations: ir.IRBuilder, by_sets: BySets, for_all: ForAll
    ) -> Any:
        """Return one of the functions at x; all functions are computed at once.

        `by_sets` applies an operation, whose first argument is a builder, to each of the sets;
        `for_all` applies one operation to all sets together. `allocations` allocates memory.
        """
        if self._argument is not x:
            sizes = self.sets, self.sets * len(self.names)
            inputs, outputs = (allocations.alloca(DOUBLES, size=size) for size in sizes)

            def store(b: ir.IRBuilder, vector: Value, index: Value) -> None:
                b.store(vector, inputs if self.sets == 1 else b.gep(inputs, [index]))

            by_sets(store, x, self._row(0))
            for_all(lambda b: b.call(self.function, [inputs, outputs]))
            self._values = {
                function: by_sets(lambda b, k: b.load(b.gep(outputs, [k])), self._row(index))
                for index, function in enumerate(self.names)
            }
            self._argument = x
        return self._values[name]

    def forget(self) -> None:
        """Forget the last call: its values do not exist in the blocks that follow."""
        self._argument, self._values = None, {}

    def _row(self, index: int) -> Any:
        """Return the indices of one function's vectors in memory, or of its one vector."""
        places = (constant(index * self.sets + lane_set, 64) for lane_set in range(self.sets))
        return next(places) if self.sets == 1 else tuple(places)

    @cached_property
    def function(self) -> ir.Function:
        """The LLVM function `void(x, y)`: it reads vectors at x, and writes all values of the first
        function to y, then those of the second. Inlined it would be longer than all the rest."""
        pointer, count = DOUBLES.as_pointer(), constant(self.sets, 64)
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        function = ir.Function(self.module, kind, "libm_circle")
        function.linkage = "internal"
        function.attributes.add("noinline")
        entry, next_set, after = map(function.append_basic_block, ("entry", "each", "after"))
        b = ir.IRBuilder(entry)
        b.branch(next_set)
        b.position_at_end(next_set)
        at_set, *unsure = (b.phi(I64) for _ in range(1 + len(self.names)))
        for phi in (at_set, *unsure):
            phi.add_incoming(constant(0, 64), entry)
        values = sin_and_cos(b, b.load(b.gep(function.args[0], [at_set])))
        shift, further = b.mul(at_set, constant(LANES, 64)), b.add(at_set, constant(1, 64))
        for at, (name, bits) in enumerate(zip(self.names, unsure, strict=True)):
            address = b.gep(function.args[1], [b.add(at_set, constant(at * self.sets, 64))])
            b.store(values[name].nearest, address)
            more = b.zext(b.bitcast(values[name].unsure, ir.IntType(LANES)), I64)
            bits.add_incoming(b.or_(bits, b.shl(more, shift)), next_set)
        at_set.add_incoming(further, next_set)
        b.cbranch(b.icmp_unsigned("<", further, count), next_set, after)
        b.position_at_end(after)
        for at, (name, bits) in enumerate(zip(self.names, unsure, strict=True)):
            places = (function.args[0], b.gep(function.args[1], [constant(at * self.sets, 64)]))
            x, y = (b.bitcast(address, DOUBLE.as_pointer()) for address in places)
            _call_libm(b, float_function(self.module, name), x, y, bits.incomings[1][0])
        b.ret_void()
        return function


def _call_libm(
    b: ir.IRBuilder, function: ir.Function, x: Value, y: Value, lane_bits: Value
) -> None:
    """Set y = f(x) where the bit of a lane is set."""
    head, lane, done = map(b.append_basic_block, ("head", "lane", "done"))
    entry, zero = b.block, constant(0, 64)
    b.branch(head)
    b.position_at_end(head)
    remaining = b.phi(I64)
    remaining.add_incoming(lane_bits, entry)
    b.cbranch(b.icmp_unsigned("!=", remaining, zero), lane, done)
    b.position_at_end(lane)
    lane_index = b.cttz(remaining, ir.Constant(BOOL, 1))
    b.store(b.call(function, [b.load(b.gep(x, [lane_index]))]), b.gep(y, [lane_index]))
    remaining.add_incoming(b.and_(remaining, b.sub(remaining, constant(1, 64))), lane)
    b.branch(head)
    b.position_at_end(done)


def sin_and_cos(b: ir.IRBuilder, x: Value) -> dict[str, NearestDouble]:
    """Return sin x and cos x."""
    parts = reduce(b, x)
    odd = b.icmp_unsigned("!=", b.and_(parts.quarter, splat(1)), splat(0))
    near_0 = b.fcmp_ordered("<", absolute(b, x), vectors.splat_double(_NEAR_0_LIMIT))
    rooms = [vectors.splat_double(0.5 / share) for share in (SURE_DISTANCE_NEAR_0, SURE_DISTANCE)]
    sine, sure = _round(b, parts.sine, b.select(near_0, *rooms))
    # Near 0 with an odd k, sin x is ±cos r, with |x| beyond π/4.
    cosine, also_sure = _round(b, parts.cosine, b.select(b.and_(near_0, odd), *rooms))
    sin, cos = b.select(odd, cosine, sine), b.select(odd, sine, cosine)
    quarters = parts.quarter, b.add(parts.quarter, splat(1))
    near = b.select(odd, also_sure, sure), b.select(odd, sure, also_sure)
    return {
        name: NearestDouble(
            _negate_by_quarter(b, value, quarter), b.not_(b.and_(is_near, parts.within))
        )
        for name, value, quarter, is_near in zip(NAMES, (sin, cos), quarters, near, strict=True)
    }


def reduce(b: ir.IRBuilder, x: Value) -> ReducedArgument:
    """Return sin r and cos r for x = k π/2 + r, within 0.012 units in the last place."""
    parts = _quarter_turn()
    shifter, inverse = (
        vectors.splat_double(_INTEGER_SHIFTER),
        vectors.splat_double(float(1 / sum(map(Fraction, parts)))),
    )
    # Adding 1.5·2^52 rounds x·2/π to the integer k, whose last bits are those of the sum.
    shifted_quarters = multiply_add(b, x, inverse, shifter)
    minus_k = b.fsub(shifter, shifted_quarters)
    first, second, third = map(vectors.splat_double, parts)
    near = exact_sum(b, multiply_add(b, minus_k, first, x), b.fmul(minus_k, second))
    r = exact_sum(b, near.high, multiply_add(b, minus_k, third, near.low))
    is_accurate = b.and_(
        b.fcmp_ordered("<=", absolute(b, x), vectors.splat_double(_MAX_ARGUMENT)),
        b.fcmp_ordered(">=", absolute(b, r.high), vectors.splat_double(_MIN_REMAINDER)),
    )
    return ReducedArgument(*_sine_and_cosine(b, r), b.bitcast(shifted_quarters, WORDS), is_accurate)


def _sine_and_cosine(b: ir.IRBuilder, r: DoubleDouble) -> tuple[DoubleDouble, DoubleDouble]:
    """Return sin r and cos r, for |r| at most a little above π/4."""
    z = times(b, r, r)
    more = times(b, r, times(b, z, _series(b, z.high, _SINE[1:])))
    sine = plus(b, r.high, DoubleDouble(more.high, b.fadd(r.low, more.low)))
    cosine = _series(b, z.high, _COSINE[2:])
    for coefficient in _COSINE[1::-1]:
        cosine = plus(b, vectors.splat_double(float(coefficient)), times(b, z, cosine))
    return sine, cosine


def _series(b: ir.IRBuilder, z: Value, coefficients: Sequence[Fraction]) -> DoubleDouble:
    """Return Σ cₙ zⁿ: the terms with n ≥ 1 in float64, c₀ and the sum as pairs."""
    first, *others = coefficients
    *lower, total = (vectors.splat_double(float(c)) for c in others)
    for c in reversed(lower):
        total = multiply_add(b, total, z, c)
    rest = vectors.splat_double(float(first - Fraction(float(first))))
    return exact_sum(b, vectors.splat_double(float(first)), multiply_add(b, total, z, rest))


def _round(b: ir.IRBuilder, value: DoubleDouble, room: Value) -> tuple[Value, Value]:
    """Return the nearest float64, and the condition that it stays the nearest if the remainder is
    multiplied by `room`: false at a power of two and before it, where the unit changes."""
    nearest = exact_sum(b, *value)
    same = b.fcmp_ordered("==", multiply_add(b, nearest.low, room, nearest.high), nearest.high)
    after = b.and_(b.add(b.bitcast(nearest.high, WORDS), splat(1)), splat(_MANTISSA))
    return nearest.high, b.and_(same, b.icmp_unsigned(">", after, splat(1)))


def _negate_by_quarter(b: ir.IRBuilder, x: Value, quarter: Value) -> Value:
    """Return −x where bit 1 of the number of quarter turns is set."""
    sign = b.shl(b.and_(quarter, splat(2)), splat(62))
    return b.bitcast(b.xor(b.bitcast(x, WORDS), sign), DOUBLES)
