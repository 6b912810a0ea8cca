"""Sums of the low and the high 52 bits of products, by the instructions that a processor has.

AVX-512 IFMA adds either half of a product of 52-bit words in one instruction. AVX2 has the fused
multiply-add of float64, whose rounding splits a product of two integers exactly:

    k = x y + 2^104 rounded to its 53 bits, which is 2^104 + 2^52 times an integer;
    r = x y + (2^104 − k), which is an integer, and at most 2^51 in size.

So both halves are computed without a change of the rounding mode; the low half may be negative.
Without either instruction products of 128 bits give the same sums, slowly: for tests.

A long product is a sum of such halves by columns: xᵢ yⱼ is added to column i + j and the next one.
"""

import struct
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.vectors import DOUBLES, LANES, LIMB_BITS, WORDS, splat, splat_double
from verify.arithmetic.wide.limbs import Value

# The low bits of the float64 2^52 + x hold an integer x ≥ 0, those of 1.5·2^52 + x an integer of
# either sign, |x| ≤ 2^51. With the 2^104 below they hold x y / 2^52 likewise.
_UNIT, _ABOUT_0 = 2.0**52, 1.5 * 2.0**52
_HIGH, _HIGH_ABOUT_0 = 2.0**104, 1.5 * 2.0**104


@dataclass
class Sum:
    """A sum in each lane: a vector, and a number known at compile time, the same in all lanes."""

    vector: Value | None = None
    constant: int = 0

    def add(self, b: ir.IRBuilder, part: Value, excess: int = 0) -> None:
        """Add a part that is too large by `excess`."""
        self.vector = part if self.vector is None else b.add(self.vector, part)
        self.constant -= excess

    def total(self, b: ir.IRBuilder) -> Value:
        if self.vector is None:
            return splat(self.constant)
        return b.add(self.vector, splat(self.constant)) if self.constant else self.vector


class MultiplyAdd(ABC):
    """Products of factors: limbs of 52 bits, or the highest limb of a signed number."""

    signed = False  # True if a factor keeps its sign; else the low 52 bits of a word count
    leaves_out = False  # True if a long product is faster without its lowest columns

    @abstractmethod
    def factor(self, b: ir.IRBuilder, limb: Value, *, highest: bool = False) -> Value:
        """Return a limb in the form in which it is multiplied. Its low 52 bits count; the `highest`
        limb may be negative, and is below 2^51 in size."""

    @abstractmethod
    def sum(self, start: int = 0) -> Sum:
        """Return a new sum that begins with `start`."""

    @abstractmethod
    def add_high(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        """Add the product of two factors, neither negative, divided by 2^52 and rounded down."""

    def add_near(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        """Add the product divided by 2^52, rounded down or to the nearest; neither is negative."""
        self.add_high(b, total, x, y)

    @abstractmethod
    def add_product(
        self, b: ir.IRBuilder, low: Sum, high: Sum | None, x: Value, y: Value, *, signed: bool
    ) -> None:
        """Add the product in two parts, the second of them divided by 2^52: only together are they
        exact.

        `signed`: a factor may be negative. Without `high` the second part is left out.
        """

    def add_shifted(self, b: ir.IRBuilder, low: Value, x: Value, shift: int) -> Value:
        """Return low + the low 52 bits of x·2^shift."""
        return b.add(low, vectors.mask(b, vectors.up(b, x, shift)))


class _WordProducts(MultiplyAdd):
    """Products whose factors are words, of which the low 52 bits count."""

    def factor(self, b: ir.IRBuilder, limb: Value, *, highest: bool = False) -> Value:
        return limb

    def sum(self, start: int = 0) -> Sum:
        return Sum(splat(start))

    @abstractmethod
    def add_low(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        """Add the low 52 bits of the product."""

    def add_product(
        self, b: ir.IRBuilder, low: Sum, high: Sum | None, x: Value, y: Value, *, signed: bool
    ) -> None:
        self.add_low(b, low, x, y)
        if high is not None:
            self.add_high(b, high, x, y)


class Avx512(_WordProducts):
    """Products by the instructions of AVX-512 IFMA."""

    def add_low(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        total.vector = self._instruction(b, "l", total.vector, x, y)

    def add_high(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        total.vector = self._instruction(b, "h", total.vector, x, y)

    def add_shifted(self, b: ir.IRBuilder, low: Value, x: Value, shift: int) -> Value:
        return self._instruction(b, "l", low, x, splat(1 << shift))

    def _instruction(
        self, b: ir.IRBuilder, half: str, a: Value | None, x: Value, y: Value
    ) -> Value:
        function = vectors.declare(
            b.module, f"llvm.x86.avx512.vpmadd52{half}.uq.512", WORDS, [WORDS] * 3
        )
        return b.call(function, [splat(0) if a is None else a, x, y])


class Portable(_WordProducts):
    """Products of 128 bits."""

    def add_low(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        total.add(b, vectors.mask(b, b.mul(vectors.mask(b, x), vectors.mask(b, y))))

    def add_high(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        long = ir.VectorType(ir.IntType(128), LANES)
        product = b.mul(*(b.zext(vectors.mask(b, v), long) for v in (x, y)))
        total.add(b, b.trunc(b.lshr(product, ir.Constant(long, [LIMB_BITS] * LANES)), WORDS))


class Fused(MultiplyAdd):
    """Products by fused multiply-adds of float64, to which factors are converted."""

    signed, leaves_out = True, True

    def factor(self, b: ir.IRBuilder, limb: Value, *, highest: bool = False) -> Value:
        if highest:
            biased = b.add(limb, splat(_bits(_ABOUT_0)))
            return b.fsub(b.bitcast(biased, DOUBLES), splat_double(_ABOUT_0))
        biased = b.or_(vectors.mask(b, limb), splat(_bits(_UNIT)))
        return b.fsub(b.bitcast(biased, DOUBLES), splat_double(_UNIT))

    def sum(self, start: int = 0) -> Sum:
        return Sum(None, start)

    def add_high(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        high, rest = self._split(b, x, y, _HIGH)
        # The fused multiply-add rounds to the nearest: if the remainder is negative, the high
        # part was rounded up, and −1 (the sign-extended condition) corrects it.
        total.add(b, b.sext(b.fcmp_ordered("<", rest, splat_double(0.0)), WORDS))
        total.add(b, b.bitcast(high, WORDS), _bits(_HIGH))

    def add_near(self, b: ir.IRBuilder, total: Sum, x: Value, y: Value) -> None:
        above = vectors.multiply_add(b, x, y, splat_double(_HIGH))
        total.add(b, b.bitcast(above, WORDS), _bits(_HIGH))

    def add_product(
        self, b: ir.IRBuilder, low: Sum, high: Sum | None, x: Value, y: Value, *, signed: bool
    ) -> None:
        about = _HIGH_ABOUT_0 if signed else _HIGH
        above, rest = self._split(b, x, y, about)
        low.add(b, self._integer_bits(b, rest), _bits(_ABOUT_0))
        if high is not None:
            high.add(b, b.bitcast(above, WORDS), _bits(about))

    def _split(self, b: ir.IRBuilder, x: Value, y: Value, about: float) -> tuple[Value, Value]:
        """Return (`about` + the high part of the product, the low part), both in float64."""
        start = splat_double(about)
        above = vectors.multiply_add(b, x, y, start)
        return above, vectors.multiply_add(b, x, y, b.fsub(start, above))

    def _integer_bits(self, b: ir.IRBuilder, x: Value) -> Value:
        """Return the bits of 1.5·2^52 + x for an integer |x| ≤ 2^51: as a word they are the bits of
        1.5·2^52 plus x."""
        return b.bitcast(b.fadd(x, splat_double(_ABOUT_0)), WORDS)


def _bits(x: float) -> int:
    return int(struct.unpack("<q", struct.pack("<d", x))[0])


class Columns:
    """The columns of a long product from `low` to `top`; their carries have not moved.

    Products above `top` are left out. Of a product in the column beneath `low` the high half is
    added, rounded down or to the nearest; of products further below nothing is.
    """

    def __init__(
        self,
        multiply_add: MultiplyAdd,
        low: int,
        top: int,
        start: Mapping[int, int] = MappingProxyType({}),
        *,
        exact: bool = False,
    ) -> None:
        """`start`: a number to add to each column; `exact`: high halves are rounded down, so that
        less than a unit of a single product is left out."""
        self.multiply_add, self.low, self.top = multiply_add, low, top
        self.sums = {c: multiply_add.sum(start.get(c, 0)) for c in range(low, top + 1)}
        self._add_half = multiply_add.add_high if exact else multiply_add.add_near

    def add(self, b: ir.IRBuilder, x: Value, y: Value, c: int, *, signed: bool = False) -> None:
        """Add the product of two factors in column c; `signed`: a factor may be negative."""
        # Of a product one column below the kept ones the high half is added to the lowest kept
        # column; further down a product is less than a unit.
        if c == self.low - 1:
            self._add_half(b, self.sums[self.low], x, y)
        elif self.low <= c <= self.top:
            above = self.sums[c + 1] if c < self.top else None
            self.multiply_add.add_product(b, self.sums[c], above, x, y, signed=signed)

    def total(self, b: ir.IRBuilder) -> dict[int, Value]:
        return {c: total.total(b) for c, total in self.sums.items()}
