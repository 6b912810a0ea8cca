"""Products of wide integers from 64-bit limbs, as LLVM IR; only the limbs that are kept are formed.

LLVM has integers of any width, and adds and shifts them well. But it forms every partial product of
two of them twice (once for the sign), so products are written here.

A product xᵢ yⱼ of limbs stands in column i + j. If the low columns are not kept, the lowest kept
column still needs the carry from below: the high halves of the column beneath it are added, and
nothing else. The omitted part is less than 2·`count` units of the lowest kept column, where `count`
is the number of limbs; each routine says what that means for its result.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

from llvmlite import ir

from verify.arithmetic.wide.size import EXTRA_SUM_BITS, WORD, size_of, width_of

I64 = ir.IntType(64)
I128 = ir.IntType(128)

Value: TypeAlias = ir.Value


def bits(count: int) -> ir.IntType:
    return ir.IntType(count)


def constant(value: int, width: int) -> Value:
    return ir.Constant(bits(width), value % (1 << width))


def words(values: Sequence[int]) -> ir.Constant:
    """Return a table of 64-bit words as one text: an `ir.Constant` would make and write every word
    again in each module."""
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
    """Return x in `width` bits: extended, or cut to its low bits."""
    if x.type.width == width:
        return x
    if x.type.width > width:
        return b.trunc(x, bits(width))
    return (b.sext if signed else b.zext)(x, bits(width))


def extra_integer_bits(x: Value, fraction: int) -> int:
    """Return the number of bits that x has before the point beyond those of a number: 64 for a sum,
    else 0."""
    return EXTRA_SUM_BITS if x.type.width > width_of(fraction) else 0


def leading(b: ir.IRBuilder, x: Value, fraction: int, beneath: int = 0) -> Value:
    """Return the leading 64 bits of a number with `fraction` fraction bits; or, with `beneath`, the
    64 bits that stand so many words below these.

    The leading bits of a number have the sign and 48 fraction bits; those of a sum are an integer.
    """
    size = size_of(fraction) + extra_integer_bits(x, fraction)
    first = size - WORD * (beneath + 1)
    return b.trunc(b.ashr(x, ir.Constant(x.type, first)) if first else x, I64)


def top(b: ir.IRBuilder, x: Value, count: int) -> Value:
    """Return the highest `count` limbs of x."""
    return resize(b, shifted_down(b, x, x.type.width - 64 * count), 64 * count)


def _columns(
    b: ir.IRBuilder, x: Value, y: Value, lowest: int, *, signed: bool, start: int = 0
) -> Value:
    """Return Σ xᵢ yⱼ 2^(64 (i + j − lowest)) over the columns ≥ lowest, plus `start` and the high
    halves of the column below, in 2·count − lowest limbs.

    The rows are added one by one, as in long multiplication by hand. `lowest` is at most `count`.
    """
    count = x.type.width // WORD
    xs, ys = _limbs(b, x), _limbs(b, y)
    total = constant(start, WORD)
    for i in range(count):
        row = {i + j: (xs[i], ys[j]) for j in range(max(0, lowest - 1 - i), count)}
        total = _with_row(b, total, row, lowest, i + count)
    for one_factor, other in [(xs, ys), (ys, xs)] if signed else []:
        total = _subtract_sign(b, total, one_factor[-1], other, lowest)
    return total


def _square_columns(b: ir.IRBuilder, x: Value, lowest: int, *, start: int, signed: bool) -> Value:
    """Return `_columns` of x and x; each mixed product is formed once and doubled."""
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
    """Return total + start + Σ u v 2^(64 (c − lowest)) over the products of a row, c their columns,
    in the columns up to `highest`; of a product in the column below `lowest` only the high half.

    The low halves are added as one number, the high halves as another: two chains of carries, and
    four instructions for each product.
    """
    low, high = {}, {}
    for c, factors in row.items():
        # LLVM compiles a 128-bit product of two zero-extended words to one instruction; a product
        # of wider integers it would form twice over.
        double_word = b.mul(*(b.zext(v, I128) for v in factors))
        low[c], high[c + 1] = b.trunc(double_word, I64), limb(b, double_word, 1)
    low.pop(lowest - 1, None)
    width = WORD * (highest - lowest + 1)
    total = resize(b, total, width)
    if row:
        low_sum, high_sum = (_place_words(b, halves, lowest, width) for halves in (low, high))
        total = b.add(total, b.add(low_sum, high_sum))
    return b.add(total, constant(start, width)) if start else total


def _place_words(b: ir.IRBuilder, words: Mapping[int, Value], lowest: int, width: int) -> Value:
    """Return Σ word·2^(64 (c − lowest)) in `width` bits, c the words' columns."""
    total = constant(0, width)
    for c, word in words.items():
        total = b.or_(total, shifted_up(b, resize(b, word, width), WORD * (c - lowest)))
    return total


def _subtract_sign(
    b: ir.IRBuilder, total: Value, sign: Value, ys: Sequence[Value], lowest: int
) -> Value:
    """Return total − Y 2^(64 (count − lowest)) if the highest limb `sign` of x is negative, else
    total: a negative highest limb was multiplied without its sign, which is 2^64 too large."""
    negative = b.ashr(sign, constant(WORD - 1, WORD))
    words = {len(ys) + i: b.and_(y, negative) for i, y in enumerate(ys)}
    return b.sub(total, _place_words(b, words, lowest, total.type.width))


def join(b: ir.IRBuilder, words: Sequence[Value]) -> Value:
    return _place_words(b, dict(enumerate(words)), 0, WORD * len(words))


class NearProduct(NamedTuple):
    """A product without its lowest columns.

    `unsure`: the condition that it may be rounded otherwise than the product from all columns;
    None if nothing is left out.
    """

    value: Value
    unsure: Value | None


def product(b: ir.IRBuilder, x: Value, y: Value, fraction: int) -> NearProduct:
    """Return x y / 2^fraction rounded to the nearest, halves upwards.

    x and y are signed, and `fraction` is at least 64·(count − 2). The columns below that of bit
    `fraction` are left out, which is less than 2·count units of the lowest kept column. It matters
    if these units carry into the result: in one of 2^44 products, or in one of 700 if few bits lie
    below.
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
    if count < 3:  # only the low half of a single product is left out: it cannot carry
        return NearProduct(rounded, None)
    dropped = b.and_(limb(b, total, 0), constant((1 << drop) - 1, 64))
    unsure = b.icmp_unsigned(">=", dropped, constant((1 << drop) - 2 * count, 64))
    return NearProduct(rounded, unsure)


def whole_product(b: ir.IRBuilder, x: Value, y: Value, fraction: int) -> Value:
    """Return x y / 2^fraction rounded to the nearest, halves upwards, from all columns."""
    total = _columns(b, x, y, 1, signed=True)
    total = b.add(total, constant(1 << (fraction - 65), total.type.width))
    return resize(b, shifted_down(b, total, fraction - 64), x.type.width)


def high_product(b: ir.IRBuilder, x: Value, y: Value, *, signed: bool = False) -> Value:
    """Return the high half of x y, too small by less than 2·count units: the product, if x and y
    are fractions."""
    width = x.type.width
    count = width // 64
    if count == 1:
        double = [resize(b, v, 128, signed=signed) for v in (x, y)]
        return limb(b, b.mul(*double), 1)
    if x is y:
        return _square_columns(b, x, count, start=0, signed=signed)
    return _columns(b, x, y, count, signed=signed)


def times_word(b: ir.IRBuilder, x: Value, word: Value) -> Value:
    """Return x·word / 2^64 rounded down, for x and word without signs."""
    row = {i: (limb_, word) for i, limb_ in enumerate(_limbs(b, x))}
    return _with_row(b, constant(0, WORD), row, 1, len(row))
