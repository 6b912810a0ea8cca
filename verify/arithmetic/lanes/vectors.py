"""Vectors of 64-bit words as LLVM IR: eight or four lanes, as a register of this processor has."""

from collections.abc import Sequence
from functools import cache

from llvmlite import binding as llvm
from llvmlite import ir

from verify.arithmetic.wide.limbs import I64, Value


@cache
def features() -> dict[str, bool]:
    """Return LLVM's names of processor features → True for those that this processor has."""
    return dict(llvm.get_host_cpu_features())


LANES = 8 if features().get("avx512f") else 4
LIMB_BITS = 52
WORDS = ir.VectorType(I64, LANES)
DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
CONDITIONS = ir.VectorType(ir.IntType(1), LANES)
_MASK = (1 << LIMB_BITS) - 1
# AVX2 cannot shift a signed word down: a word that may be negative is made positive before.
SHIFTS_SIGNS = LANES == 8
_LIMB_BIAS = 1 << 62


def splat(value: int) -> Value:
    """Return the same word in all lanes."""
    return ir.Constant(WORDS, [value % (1 << 64)] * LANES)


def splat_double(value: float) -> Value:
    return ir.Constant(DOUBLES, [value] * LANES)


def same(b: ir.IRBuilder, value: Value, kind: ir.VectorType) -> Value:
    """Return a scalar, repeated in all lanes."""
    first = b.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(I64, 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return b.shuffle_vector(first, ir.Constant(kind, ir.Undefined), zeros)


def in_lanes(b: ir.IRBuilder, condition: Value) -> Value:
    """Return a condition as a vector; one bit for all lanes is repeated."""
    return condition if condition.type == CONDITIONS else same(b, condition, CONDITIONS)


def lanes_of(b: ir.IRBuilder, x: Value) -> list[Value]:
    """Return the words of all lanes, as scalars."""
    return [b.extract_element(x, ir.Constant(I64, lane)) for lane in range(LANES)]


def shuffle(b: ir.IRBuilder, x: Value, y: Value, places: Sequence[int]) -> Value:
    """Return the elements at these places of x followed by y."""
    kind = ir.VectorType(ir.IntType(32), len(places))
    return b.shuffle_vector(x, y, ir.Constant(kind, list(places)))


def mask(b: ir.IRBuilder, x: Value) -> Value:
    """Return the low 52 bits."""
    return b.and_(x, splat(_MASK))


def settle(b: ir.IRBuilder, limbs: Sequence[Value]) -> list[Value]:
    """Return limbs whose carries have moved, all but the highest cut to their low 52 bits."""
    *low, high = limbs
    return [*(mask(b, limb) for limb in low), high]


def down(b: ir.IRBuilder, x: Value, shift: int) -> Value:
    """Return x / 2^shift rounded down, for a signed x."""
    return b.ashr(x, splat(shift)) if shift else x


def up(b: ir.IRBuilder, x: Value, shift: int) -> Value:
    return b.shl(x, splat(shift)) if shift else x


def down_positive(b: ir.IRBuilder, x: Value, shift: int) -> Value:
    """Return x / 2^shift rounded down; x may be negative only if `SHIFTS_SIGNS` is true."""
    return down(b, x, shift) if SHIFTS_SIGNS else b.lshr(x, splat(shift))


def carry(b: ir.IRBuilder, limbs: Sequence[Value]) -> list[Value]:
    """Return limbs, each below 2^62 in size, after their carries have moved.

    The highest limb has the sign; only the low 52 bits of the others count.
    """
    moved_limbs: list[Value] = []
    # Without an arithmetic shift a limb is made positive by 2^62 before it is shifted; the same
    # amount, shifted, is taken from the next limb, so that the sum is unchanged.
    above = 0 if SHIFTS_SIGNS else _LIMB_BIAS
    for i, limb in enumerate(limbs):
        start = (above if i + 1 < len(limbs) else 0) - (above >> LIMB_BITS if i else 0)
        moved = b.add(limb, splat(start)) if start else limb
        moved_limbs.append(
            b.add(moved, down_positive(b, moved_limbs[-1], LIMB_BITS)) if moved_limbs else moved
        )
    return moved_limbs


def any_of(b: ir.IRBuilder, condition: Value) -> Value:
    """Return the condition that a condition holds in some lane, as one bit."""
    bits = b.bitcast(condition, ir.IntType(LANES))
    return b.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(LANES), 0))


def declare(
    module: ir.Module, name: str, result: ir.Type, arguments: Sequence[ir.Type]
) -> ir.Function:
    """Return the function of that name; declare it in the module if it is new there."""
    if name not in module.globals:
        ir.Function(module, ir.FunctionType(result, arguments), name)
    return module.globals[name]


def intrinsic(module: ir.Module, name: str) -> ir.Function:
    """Return LLVM's intrinsic of that name, for one vector of doubles."""
    return declare(module, f"llvm.{name}.v{LANES}f64", DOUBLES, [DOUBLES])


def absolute(b: ir.IRBuilder, x: Value) -> Value:
    """Return |x| of float64."""
    return b.call(intrinsic(b.module, "fabs"), [x])


def multiply_add(b: ir.IRBuilder, x: Value, y: Value, z: Value) -> Value:
    """Return x y + z, rounded once."""
    name, kinds = f"llvm.fma.v{LANES}f64", [DOUBLES] * 3
    return b.call(declare(b.module, name, DOUBLES, kinds), [x, y, z])
