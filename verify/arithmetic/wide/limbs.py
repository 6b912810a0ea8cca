"""Products of wide integers from 64-bit limbs, as LLVM IR; only the limbs that are kept are formed.

LLVM has integers of any width, and adds and shifts them well. Its product of two of them forms
every partial product twice over (once for the sign), so products are written here.

A product xᵢ yⱼ of limbs stands in column i + j. If the low columns are not kept, the lowest kept
column still needs the carry from below: of the column beneath it only the high halves are added.
What is left out is less than 2·`count` units of the lowest kept column, where `count` is the number
of limbs; each routine says what that means for its result.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

from llvmlite import ir

from verify.arithmetic.wide.size import MORE_OF_SUMS, WORD, size_of, width_of

I64 = ir.IntType(64)
I128 = ir.IntType(128)

Value: TypeAlias = ir.Value


def bits(count: int) -> ir.IntType:
    return ir.IntType(count)


def constant(value: int, width: int) -> Value:
    return ir.Constant(bits(width), value % (1 << width))


def words(values: Sequence[int]) -> ir.Constant:
    """Return a table of 64-bit words, written once: of an `ir.Constant` each module makes and
    writes every word again."""
    text = ", ".join(f"i64 {value}" for value in values)
    return ir.FormattedConstant(ir.ArrayType(I64, len(values)), f"[{text}]")


def limb(b: ir.IRBuilder, x: Value, index: int) -> Value:
    """Return the limb of that index; limb 0 is the lowest."""
    if x.type.width == 64:
        return x
    return b.trunc(shifted_down(b, x, 64 * index), I64)


def shifted_down(b: ir.IRBuilder, x: Value, shift: int) -> Value:
    return b.lshr(x, ir.Constant(x.type, shift)) if shift else x


def shifted_up(b: ir.IRBuilder, x: Value, shift: int) -> Value:
    return b.shl(x, ir.Constant(x.type, shift)) if shift else x


def resize(b: ir.IRBuilder, x: Value, width: int, *, signed: bool = False) -> Value:
    """Return x in so many bits: extended, or cut to its low ones."""
    if x.type.width == width:
        return x
    if x.type.width > width:
        return b.trunc(x, bits(width))
    return (b.sext if signed else b.zext)(x, bits(width))


def more_before_point(x: Value, fraction: int) -> int:
    """Return the bits that x has before the point beyond a number's: those of a sum, or none."""
    return MORE_OF_SUMS if x.type.width > width_of(fraction) else 0


def leading(b: ir.IRBuilder, x: Value, fraction: int, beneath: int = 0) -> Value:
    """Return the leading 64 bits of a number with so many fraction bits, the sign among them, 48 of
    them fraction bits; or so many words beneath these.

    Of a sum the leading 64 bits are whole.
    """
    size = size_of(fraction) + more_before_point(x, fraction)
    first = size - WORD * (beneath + 1)
    return b.trunc(b.ashr(x, ir.Constant(x.type, first)) if first else x, I64)


def top(b: ir.IRBuilder, x: Value, count: int) -> Value:
    """Return the highest `count` limbs of x."""
    return resize(b, shifted_down(b, x, x.type.width - 64 * count), 64 * count)


def _columns(
    b: ir.IRBuilder, x: Value, y: Value, lowest: int, *, signed: bool, start: int = 0
) -> Value:
    """Return Σ xᵢ yⱼ 2^(64 (i + j − lowest)) over the columns ≥ lowest, plus `start` and the high
    halves of the column below: 2·count − lowest limbs.

    Row by row, as one multiplies by hand. `lowest` is `count` at most.
    """
    count = x.type.width // WORD
    xs, ys = _limbs(b, x), _limbs(b, y)
    total = constant(start, WORD)
    for i in range(count):
        row = {i + j: (xs[i], ys[j]) for j in range(max(0, lowest - 1 - i), count)}
        total = _with_row(b, total, row, lowest, i + count)
    for first, second in [(xs, ys), (ys, xs)] if signed else []:
        total = _subtract_sign(b, total, first[-1], second, lowest)
    return total


def _square_columns(b: ir.IRBuilder, x: Value, lowest: int, *, start: int, signed: bool) -> Value:
    """Return `_columns` of x·x, each mixed product formed once and doubled."""
    count = x.type.width // WORD
    xs = _limbs(b, x)
    mixed = constant(0, WORD)
    for i in range(count - 1):
        row = {i + j: (xs[i], xs[j]) for j in range(max(i + 1, lowest - 1 - i), count)}
        mixed = _with_row(b, mixed, row, lowest, i + count)
    mixed = resize(b, mixed, WORD * (2 * count - lowest))
    if signed:
        mixed = _subtract_sign(b, mixed, xs[-1], xs, lowest)
    squares = {2 * i: (xs[i], xs[i]) for i in range(lowest // 2, count)}
    return _with_row(b, b.add(mixed, mixed), squares, lowest, 2 * count - 1, start)


def _limbs(b: ir.IRBuilder, x: Value) -> list[Value]:
    return [limb(b, x, i) for i in range(x.type.width // WORD)]


def _with_row(
    b: ir.IRBuilder,
    total: Value,
    row: Mapping[int, tuple[Value, Value]],
    lowest: int,
    highest: int,
    start: int = 0,
) -> Value:
    """Return total + start + Σ u v 2^(64 (c − lowest)) over a row's products, c their columns, in
    the columns up to `highest`; of one in the column below the lowest the high half.

    The low halves are one number and the high ones another: each takes a chain of carries, which
    makes four instructions a product.
    """
    low, high = {}, {}
    for c, factors in row.items():
        # LLVM compiles a 128-bit product of two zero-extended words to one instruction; a product
        # of wider integers it would form twice over.
        whole = b.mul(*(b.zext(v, I128) for v in factors))
        low[c], high[c + 1] = b.trunc(whole, I64), limb(b, whole, 1)
    low.pop(lowest - 1, None)
    width = WORD * (highest - lowest + 1)
    total = resize(b, total, width)
    if row:
        first, second = (_place_words(b, halves, lowest, width) for halves in (low, high))
        total = b.add(total, b.add(first, second))
    return b.add(total, constant(start, width)) if start else total


def _place_words(b: ir.IRBuilder, words: Mapping[int, Value], lowest: int, width: int) -> Value:
    """Return Σ word·2^(64 (c − lowest)) in so many bits."""
    total = constant(0, width)
    for c, word in words.items():
        total = b.or_(total, shifted_up(b, resize(b, word, width), WORD * (c - lowest)))
    return total


def _subtract_sign(
    b: ir.IRBuilder, total: Value, sign: Value, ys: Sequence[Value], lowest: int
) -> Value:
    """Return total − Y 2^(64 (count − lowest)) if the highest limb `sign` of x is negative:
    its word without a sign is too large by 2^64, and Y is multiplied by it."""
    negative = b.ashr(sign, constant(WORD - 1, WORD))
    words = {len(ys) + i: b.and_(y, negative) for i, y in enumerate(ys)}
    return b.sub(total, _place_words(b, words, lowest, total.type.width))


def join(b: ir.IRBuilder, words: Sequence[Value]) -> Value:
    return _place_words(b, dict(enumerate(words)), 0, WORD * len(words))


class NearProduct(NamedTuple):
    """A product without its lowest columns, and whether it may be rounded otherwise than the whole
    one; None: nothing is left out."""

    value: Value
    unsure: Value | None


def product(b: ir.IRBuilder, x: Value, y: Value, fraction: int) -> NearProduct:
    """Return x y / 2^fraction rounded to the nearest, halves upwards.

    Signed, `fraction` in the second highest limb's column or above. The columns below it are left
    out, which is less than 2·count units of the lowest that is kept: it matters if these units
    carry into the result, in one of 2^44 products, or of 700 if few bits lie below.
    """
    width = x.type.width
    count, lowest = width // 64, fraction // 64
    drop = fraction - 64 * lowest
    half = 1 << (drop - 1)
    if x is y:
        total = _square_columns(b, x, lowest, start=half, signed=True)
    else:
        total = _columns(b, x, y, lowest, signed=True, start=half)
    rounded = resize(b, shifted_down(b, total, drop), width)
    if count < 3:  # of the column below, a single product's low half is left out
        return NearProduct(rounded, None)
    dropped = b.and_(limb(b, total, 0), constant((1 << drop) - 1, 64))
    unsure = b.icmp_unsigned(">=", dropped, constant((1 << drop) - 2 * count, 64))
    return NearProduct(rounded, unsure)


def whole_product(b: ir.IRBuilder, x: Value, y: Value, fraction: int) -> Value:
    """Return the same, from all columns."""
    total = _columns(b, x, y, 1, signed=True)
    total = b.add(total, constant(1 << (fraction - 65), total.type.width))
    return resize(b, shifted_down(b, total, fraction - 64), x.type.width)


def high_product(b: ir.IRBuilder, x: Value, y: Value, *, signed: bool = False) -> Value:
    """Return the high half of x y: for fractions their product, too small by less than 2·count
    units."""
    width = x.type.width
    count = width // 64
    if count == 1:
        double = [resize(b, v, 128, signed=signed) for v in (x, y)]
        return limb(b, b.mul(*double), 1)
    if x is y:
        return _square_columns(b, x, count, start=0, signed=signed)
    return _columns(b, x, y, count, signed=signed)


def times_word(b: ir.IRBuilder, x: Value, word: Value) -> Value:
    """Return x·word / 2^64 rounded down, neither with a sign."""
    row = {i: (limb_, word) for i, limb_ in enumerate(_limbs(b, x))}
    return _with_row(b, constant(0, WORD), row, 1, len(row))
