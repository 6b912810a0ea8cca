"""The functions sin and cos of float64 in lanes, with the bits of glibc's own.

glibc's are within 0.518 units in the last place of the value, and sin x with |x| < 0.8555 within
0.548, as its source says (`s_sin.c`, since 2.28); what Gladman, Innocente, Mather and Zimmermann
have found is 0.516 (*Accuracy of Mathematical Functions*). So if the value is within 0.482 or
0.452 units of a float64, that is what glibc gives: the next one is too far off. If it is not, as
for one value of fourteen, glibc is asked. With another C library, or a processor without fused
multiply-add, it is asked for all.

Here x = k·π/2 + r, sin r = r + r z (−1/6 + z T), cos r = 1 + z (−1/2 + z (1/24 + z U)), z = r² at
most 0.617. z T and z U are Taylor polynomials in float64, all else is in pairs of such. What is
lost, in u = 2^−53 of the value: z T is within 4.2 u of itself, 2.1 for the low part of z, which it
does not have, the rest for its first coefficient and its sums; z² T is at most 0.0035 of the sine;
z U is within as much, and z³ U at most 0.0005 of the cosine; what the series leave out is below
0.0011 u; r, which is not below 2^−12, is within 2^−37 u, and pairs lose as little. Together it is
less than 0.016 u, and that only of sines from ½ to 0.7072, where u of the value is 0.7072 units at
most; of all others, less than 0.005 u. So it is less than 0.012 units in the last place.
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
SURE, SURE_NEAR_0 = 0.47, 0.44  # of a unit in the last place, the latter for a sine
_NEAR_0 = 0.8555  # |x| below it
_FARTHEST, _LEAST = 2.0**18, 2.0**-12  # |x| at most, |r| at least
_WHOLE = 1.5 * 2.0**52  # what is added to it is rounded to an integer, which its low bits hold
_BITS = 33  # of the first two parts of π/2: x less k times the first, and k times the second, exact
_MANTISSA = (1 << 52) - 1
_SINE = [Fraction((-1) ** n, factorial(2 * n + 1)) for n in range(9)]
_COSINE = [Fraction((-1) ** n, factorial(2 * n)) for n in range(10)]
BySets: TypeAlias = Callable[..., Any]
ForAll: TypeAlias = Callable[[Callable[[ir.IRBuilder], Any]], None]


class DoubleDouble(NamedTuple):
    """high + low, a vector of float64 each, |low| far below |high|.

    A product, and a sum whose first term is the larger one, loses some units of 2^−104 of it. Low
    may be some units in the last place of high: what takes high alone must allow for that.
    """

    high: Value
    low: Value


def exact_sum(b: ir.IRBuilder, x: Value, y: Value) -> DoubleDouble:
    """Return x + y, |x| ≥ |y|: rounded, and the error of the rounding."""
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
    """x = k π/2 + r: sin r and cos r before they are rounded, k in low bits, and in which lanes all
    that is as close as is promised."""

    sine: DoubleDouble
    cosine: DoubleDouble
    quarter: Value
    within: Value


class NearestDouble(NamedTuple):
    """The nearest float64, and in which lanes it may not be what glibc gives."""

    nearest: Value
    unsure: Value


@cache
def is_available() -> bool:
    """Return True if the C library is one with these bounds, and the processor has fused
    multiply-add.

    If a fused multiply-add is itself a call, the library's own sine is faster.
    """
    try:
        name, _, version = (os.confstr("CS_GNU_LIBC_VERSION") or "").partition(" ")
        is_analysed = name == "glibc" and tuple(map(int, version.split(".")[:2])) >= (2, 28)
    except (AttributeError, ValueError, OSError):  # another library, or another system
        return False
    return is_analysed and vectors.features().get("fma", False)


@cache
def _quarter_turn() -> tuple[float, float, float]:
    """Return π/2 as a sum, its first two parts of few bits."""
    places = 5 * _BITS
    with working_precision(2 * places):
        rest = Fraction(arb_integer(flint.arb.pi() / 2, places), 1 << places)
    parts = []
    for k in (1, 2):
        unit = 1 << k * _BITS - 1
        parts.append(Fraction(int(rest * unit), unit))
        rest -= parts[-1]
    return float(parts[0]), float(parts[1]), float(rest)


class LibmCircle:
    """A writer of the functions `names` into a module, for so many vectors at once, and of calls of
    them."""

    def __init__(self, module: ir.Module, sets: int, names: Sequence[str]) -> None:
        assert sets * LANES <= 64  # noqa: S101 - a word has a bit for each lane
        self.module, self.sets, self.names = module, sets, names
        self._argument: Any = None  # that of the last call, which has all functions' `_values`
        self._values: dict[str, Any] = {}

    def apply(
        self, name: str, x: Any, allocations: ir.IRBuilder, by_sets: BySets, for_all: ForAll
    ) -> Any:
        """Return one of the functions at x; all are computed at once.

        `by_sets` applies an operation, which takes a builder first, to each of the sets, `for_all`
        one to all of them; memory is allocated by `allocations`.
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
        """Forget the last call, whose values are not there where the code goes on."""
        self._argument, self._values = None, {}

    def _row(self, index: int) -> Any:
        """Return the places of one function's vectors, or of its one vector."""
        places = (constant(index * self.sets + lane_set, 64) for lane_set in range(self.sets))
        return next(places) if self.sets == 1 else tuple(places)

    @cached_property
    def function(self) -> ir.Function:
        """`void(x, y)` in memory: the functions of the vectors, first all values of one function.

        It is called, since its code would be longer than all else, and fills all registers.
        """
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
            _ask(b, float_function(self.module, name), x, y, bits.incomings[1][0])
        b.ret_void()
        return function


def _ask(b: ir.IRBuilder, function: ir.Function, x: Value, y: Value, lane_bits: Value) -> None:
    """Set y = f(x) where the bit of a lane is set."""
    head, lane, done = map(b.append_basic_block, ("head", "lane", "done"))
    before, zero = b.block, constant(0, 64)
    b.branch(head)
    b.position_at_end(head)
    remaining = b.phi(I64)
    remaining.add_incoming(lane_bits, before)
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
    near_0 = b.fcmp_ordered("<", absolute(b, x), vectors.splat_double(_NEAR_0))
    rooms = [vectors.splat_double(0.5 / share) for share in (SURE_NEAR_0, SURE)]
    sine, sure = _round(b, parts.sine, b.select(near_0, *rooms))
    # There sin x is a cosine of r beyond π/4.
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
    """Reduce x to r, within 0.012 units in the last place."""
    parts = _quarter_turn()
    whole, inverse = (
        vectors.splat_double(_WHOLE),
        vectors.splat_double(float(1 / sum(map(Fraction, parts)))),
    )
    # Adding 1.5·2^52 rounds x·2/π to an integer, which the low bits of the sum then hold (the
    # parity of k and k mod 4 are read from there).
    shifted_quarters = multiply_add(b, x, inverse, whole)
    minus_k = b.fsub(whole, shifted_quarters)  # −k
    first, second, third = map(vectors.splat_double, parts)
    near = exact_sum(b, multiply_add(b, minus_k, first, x), b.fmul(minus_k, second))
    r = exact_sum(b, near.high, multiply_add(b, minus_k, third, near.low))
    is_accurate = b.and_(
        b.fcmp_ordered("<=", absolute(b, x), vectors.splat_double(_FARTHEST)),
        b.fcmp_ordered(">=", absolute(b, r.high), vectors.splat_double(_LEAST)),
    )
    return ReducedArgument(*_sine_and_cosine(b, r), b.bitcast(shifted_quarters, WORDS), is_accurate)


def _sine_and_cosine(b: ir.IRBuilder, r: DoubleDouble) -> tuple[DoubleDouble, DoubleDouble]:
    """Return sin r and cos r, |r| ≤ π/4 and a little more."""
    z = times(b, r, r)
    more = times(b, r, times(b, z, _series(b, z.high, _SINE[1:])))
    sine = plus(b, r.high, DoubleDouble(more.high, b.fadd(r.low, more.low)))
    cosine = _series(b, z.high, _COSINE[2:])
    for coefficient in _COSINE[1::-1]:
        cosine = plus(b, vectors.splat_double(float(coefficient)), times(b, z, cosine))
    return sine, cosine


def _series(b: ir.IRBuilder, z: Value, coefficients: Sequence[Fraction]) -> DoubleDouble:
    """Return Σ cₙ zⁿ, all but c₀ in float64."""
    first, *others = coefficients
    *lower, total = (vectors.splat_double(float(c)) for c in others)
    for c in reversed(lower):
        total = multiply_add(b, total, z, c)
    rest = vectors.splat_double(float(first - Fraction(float(first))))
    return exact_sum(b, vectors.splat_double(float(first)), multiply_add(b, total, z, rest))


def _round(b: ir.IRBuilder, value: DoubleDouble, room: Value) -> tuple[Value, Value]:
    """Round to the nearest float64, and tell where that holds with `room` times the remainder, too.

    The condition is false for a power of two, and for the number below one: there units change.
    """
    nearest = exact_sum(b, *value)
    same = b.fcmp_ordered("==", multiply_add(b, nearest.low, room, nearest.high), nearest.high)
    after = b.and_(b.add(b.bitcast(nearest.high, WORDS), splat(1)), splat(_MANTISSA))
    return nearest.high, b.and_(same, b.icmp_unsigned(">", after, splat(1)))


def _negate_by_quarter(b: ir.IRBuilder, x: Value, quarter: Value) -> Value:
    """Return −x where the quarter turn's bit of value 2 is set."""
    sign = b.shl(b.and_(quarter, splat(2)), splat(62))
    return b.bitcast(b.xor(b.bitcast(x, WORDS), sign), DOUBLES)
