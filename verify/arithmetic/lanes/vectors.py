"""Eight 64-bit words side by side, as LLVM IR, and the multiply-add of their low 52 bits.

AVX-512 IFMA has it as an instruction. Elsewhere it is written with products of 128 bits, which
gives the same bits, and is slow: it is for tests on processors without that instruction.
"""

from llvmlite import ir

from verify.arithmetic.wide.limbs import I64, Value

LANES = 8
DIGIT = 52  # bits of a limb
WORDS = ir.VectorType(I64, LANES)
DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
CONDITIONS = ir.VectorType(ir.IntType(1), LANES)
_LONG = ir.VectorType(ir.IntType(128), LANES)
_MASK = (1 << DIGIT) - 1


def splat(value: int) -> Value:
    """The same word in all lanes."""
    return ir.Constant(WORDS, [value % (1 << 64)] * LANES)


def splat_double(value: float) -> Value:
    return ir.Constant(DOUBLES, [value] * LANES)


def same(b: ir.IRBuilder, value: Value, kind: ir.VectorType) -> Value:
    """A scalar in all lanes."""
    first = b.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(I64, 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return b.shuffle_vector(first, ir.Constant(kind, ir.Undefined), zeros)


def masked(b: ir.IRBuilder, x: Value) -> Value:
    """The low 52 bits."""
    return b.and_(x, splat(_MASK))


def down(b: ir.IRBuilder, x: Value, by: int) -> Value:
    """x / 2^by rounded down, x with its sign."""
    return b.ashr(x, splat(by)) if by else x


def up(b: ir.IRBuilder, x: Value, by: int) -> Value:
    return b.shl(x, splat(by)) if by else x


def any_of(b: ir.IRBuilder, condition: Value) -> Value:
    """Whether it is true in some lane."""
    bits = b.bitcast(condition, ir.IntType(LANES))
    return b.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(LANES), 0))


def intrinsic(module: ir.Module, name: str) -> ir.Function:
    """LLVM's function of that name, of one vector of doubles."""
    name = f"llvm.{name}.v{LANES}f64"
    if name not in module.globals:
        ir.Function(module, ir.FunctionType(DOUBLES, [DOUBLES]), name)
    return module.globals[name]


class MultiplyAdd:
    """a + the low or the high 52 bits of the product of x's and y's low 52 bits."""

    def __init__(self, module: ir.Module, *, native: bool) -> None:
        self.module, self.native = module, native

    def low(self, b: ir.IRBuilder, a: Value, x: Value, y: Value) -> Value:
        if self.native:
            return self._instruction(b, "l", a, x, y)
        return b.add(a, masked(b, b.mul(masked(b, x), masked(b, y))))

    def high(self, b: ir.IRBuilder, a: Value, x: Value, y: Value) -> Value:
        if self.native:
            return self._instruction(b, "h", a, x, y)
        long = [b.zext(masked(b, v), _LONG) for v in (x, y)]
        shift = ir.Constant(_LONG, [DIGIT] * LANES)
        return b.add(a, b.trunc(b.lshr(b.mul(*long), shift), WORDS))

    def _instruction(self, b: ir.IRBuilder, half: str, a: Value, x: Value, y: Value) -> Value:
        name = f"llvm.x86.avx512.vpmadd52{half}.uq.512"
        if name not in self.module.globals:
            ir.Function(self.module, ir.FunctionType(WORDS, [WORDS] * 3), name)
        return b.call(self.module.globals[name], [a, x, y])
