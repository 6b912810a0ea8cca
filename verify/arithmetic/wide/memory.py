"""Numbers in memory, 64-bit words from the lowest, as LLVM IR."""

from llvmlite import ir

from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import I64, Value, constant

DOUBLE = ir.DoubleType()


def read(b: ir.IRBuilder, memory: Value, offset: int, kind: ir.Type) -> tuple[Value, int]:
    """Return the number of that type at a word offset, and the offset behind it."""
    count = 1 if kind == DOUBLE else kind.width // 64
    words = [b.load(b.gep(memory, [constant(offset + i, 64)]), typ=I64) for i in range(count)]
    value = b.bitcast(words[0], DOUBLE) if kind == DOUBLE else limbs.join(b, words)
    return value, offset + count


def write(b: ir.IRBuilder, memory: Value, offset: int, value: Value) -> int:
    """Write a number at a word offset; return the offset behind it."""
    if value.type == DOUBLE:
        value = b.bitcast(value, I64)
    count: int = value.type.width // 64
    for i in range(count):
        b.store(limbs.limb(b, value, i), b.gep(memory, [constant(offset + i, 64)]))
    return offset + count
