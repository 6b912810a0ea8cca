"""One orbit's numbers as LLVM IR: integers of any width, variables in registers, and memory."""

import ast
import math
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir

from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import I64, Value, constant, resize
from verify.arithmetic.wide.newton import DOUBLE, MoreFunctions, from_double, to_double
from verify.arithmetic.wide.size import EXTRA_SUM_BITS, INTEGER_BITS, width_of
from verify.functions import in_rings

BOOL = ir.IntType(1)
# Functions of float64 that are LLVM's intrinsics; the others are calls to the C library of this
# process. LLVM would merge its sin and cos of one number into a call of `sincos`, which in glibc
# differs from `sin` at 1.6762…, and takes longer.
_INTRINSICS = ("exp", "log", "sqrt")


class OneOrbit:
    """A target (see `verify.arithmetic.wide.translator.Target`) for one orbit.

    A value is an LLVM value, and its LLVM type tells its kind.
    """

    def __init__(self, fraction: int) -> None:
        self.fraction, self.module, width = fraction, ir.Module(), width_of(fraction)
        self.functions = MoreFunctions(self.module, fraction)
        self.types = {"wide": limbs.bits(width), "sum": limbs.bits(width + EXTRA_SUM_BITS),
                      "float": DOUBLE, "int": I64}  # fmt: skip
        self._kinds = {str(kind_type): kind for kind, kind_type in self.types.items()}
        self._variables: dict[str, Value] = {}
        self._loop_ends: list[ir.Block] = []  # the blocks behind the loops around this point

    # -- the function -------------------------------------------------------------------------

    def begin(self, arguments: Sequence[tuple[str, str]], products: int) -> None:
        self.calls_products = self.functions.products.too_many(products)
        pointer = I64.as_pointer()
        main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), "main")
        self.allocations = ir.IRBuilder(main.append_basic_block("entry"))
        self.b = ir.IRBuilder(main.append_basic_block("body"))
        self.assign("valid", ir.Constant(BOOL, 1))
        offset = 0
        for name, kind in arguments:
            value, offset = read_number(self.b, main.args[0], offset, self.types[kind])
            self.assign(name, value)

    def end(self) -> None:
        if not self.b.block.is_terminated:
            self.b.ret_void()
        entry = self.allocations.block
        self.allocations.branch(entry.parent.blocks[1])

    def give(self, values: Callable[[], Sequence[Value]]) -> None:
        offset = 0
        for v in (*values(), resize(self.b, self.load("valid"), 64)):
            offset = write_number(self.b, self.b.function.args[1], offset, v)
        self.b.ret_void()

    def when(self, condition: Value, body: Callable[[], None]) -> None:
        inside = self.b.append_basic_block("then")
        after = self.b.append_basic_block("after")
        self.b.cbranch(condition, inside, after)
        self.b.position_at_end(inside)
        body()
        if not self.b.block.is_terminated:
            self.b.branch(after)
        self.b.position_at_end(after)

    def loop(self, name: str, limit: Value, body: Callable[[], None], assigned: set[str]) -> None:
        self.assign(name, constant(0, 64))
        head, inside, after = (self.b.append_basic_block(n) for n in ("head", "loop", "done"))
        self.b.branch(head)
        self.b.position_at_end(head)
        index = self.load(name)
        self.b.cbranch(self.b.icmp_signed("<", index, limit), inside, after)
        self.b.position_at_end(inside)
        # `break` jumps to the end of the innermost loop; loops of one orbit may be nested.
        self._loop_ends.append(after)
        body()
        self._loop_ends.pop()
        self.assign(name, self.b.add(index, constant(1, 64)))
        self.b.branch(head)
        self.b.position_at_end(after)

    def leave(self) -> None:
        self.b.branch(self._loop_ends[-1])

    def order(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        return statements

    # -- variables and numbers ----------------------------------------------------------------

    def has(self, name: str) -> bool:
        return name in self._variables

    def load(self, name: str) -> Value:
        return self.b.load(self._variables[name])

    def assign(self, name: str, value: Value) -> None:
        if name not in self._variables:
            self._variables[name] = self.allocations.alloca(value.type, name=name)
        target = self._variables[name].allocated_type
        if value.type != target:
            value = self.convert(value, self._kinds[str(target)])
        self.b.store(value, self._variables[name])

    def integer(self, value: int) -> Value:
        return constant(value, 64)

    def constant(self, value: Any) -> Value:
        if isinstance(value, float):
            return ir.Constant(DOUBLE, value)
        return constant(value.raw, self.types["wide"].width)

    def kind(self, value: Value) -> str:
        return self._kinds[str(value.type)]

    def convert(self, value: Value, kind: str) -> Value:
        target = self.types[kind]
        if value.type == I64 and kind == "float":
            return self.b.sitofp(value, DOUBLE)
        if value.type == I64:
            number = resize(self.b, value, target.width, signed=True)
            return limbs.shifted_up(self.b, number, self.fraction)
        if value.type == self.types["wide"] and kind == "sum":
            return resize(self.b, value, target.width, signed=True)
        raise TypeError(f"{value.type} is no {target}; use wide(x) or approx(x)")

    # -- operations ---------------------------------------------------------------------------

    def negative(self, x: Value) -> Value:
        return self.b.fneg(x) if x.type == DOUBLE else self.b.neg(x)

    def sum(self, sign: str, x: Value, y: Value) -> Value:
        b = self.b
        floating = x.type == DOUBLE
        if sign == "+":
            return b.fadd(x, y) if floating else b.add(x, y)
        return b.fsub(x, y) if floating else b.sub(x, y)

    def product(self, x: Value, y: Value) -> Value:
        if x.type == DOUBLE:
            return self.b.fmul(x, y)
        return self.functions.products.product(self.b, x, y, called=self.calls_products)

    def quotient(self, x: Value, y: Value) -> Value:
        return self.b.fdiv(x, y)

    def negation(self, condition: Value) -> Value:
        return self.b.not_(condition)

    def conjunction(self, x: Value, y: Value) -> Value:
        return self.b.and_(x, y)

    def disjunction(self, x: Value, y: Value) -> Value:
        return self.b.or_(x, y)

    def compare(self, order: str, x: Value, y: Value) -> Value:
        compare = self.b.fcmp_ordered if x.type == DOUBLE else self.b.icmp_signed
        return compare(order, x, y)

    def inside(self, x: Value, limit: Value) -> Value:
        """Return a condition that implies |x| < limit, from the leading 64 bits; limit > 0."""
        b = self.b
        x, limit = (limbs.leading(b, v, self.fraction) for v in (x, limit))
        # −limit < x < limit for integers is 0 < x + limit < 2·limit.
        biased = b.sub(b.add(x, limit), constant(1, 64))
        return b.icmp_unsigned("<", biased, b.sub(b.add(limit, limit), constant(1, 64)))

    # -- functions ----------------------------------------------------------------------------

    def function(self, name: str, values: Sequence[Value]) -> list[Value]:
        b, x = self.b, values[0]
        if name == "abs":
            if x.type == DOUBLE:
                return [self._absolute(x)]
            negative = b.icmp_signed("<", x, constant(0, x.type.width))
            return [b.select(negative, b.neg(x), x)]
        if name == "approx":
            return [to_double(b, x, self.fraction)]
        if name == "shifted":
            return [self._shift_down(x, values[1])]
        if name == "wide":
            limit = ir.Constant(DOUBLE, 2.0 ** (INTEGER_BITS - 1))
            self._require(b.fcmp_ordered("<", self._absolute(x), limit))
            return [from_double(b, x, self.fraction)]
        if name == "root" and x.type == DOUBLE:
            return [self._float_root(x, values[1])]
        if x.type == DOUBLE:
            return [b.call(float_function(self.module, name), [x])]
        packed = b.call(self.functions.get(name), [x])
        count = len(packed.type.elements) - 1
        self._require(b.extract_value(packed, count))
        return [b.extract_value(packed, i) for i in range(count)]

    def _require(self, condition: Value) -> None:
        """Make `valid` false unless the condition holds."""
        self.assign("valid", self.b.and_(self.load("valid"), condition))

    def _absolute(self, x: Value) -> Value:
        return self.b.call(self.module.declare_intrinsic("llvm.fabs", [DOUBLE]), [x])

    def _shift_down(self, x: Value, shift: Value) -> Value:
        """Return x / 2^shift rounded down, 0 ≤ shift < 64, limb by limb: LLVM would shift a wide
        integer more slowly."""
        b, count = self.b, x.type.width // 64
        kind = ir.FunctionType(I64, [I64] * 3)
        funnel = self.module.declare_intrinsic("llvm.fshr", [I64], kind)
        words = [limbs.limb(b, x, i) for i in range(count)]
        # Above the highest word stands its sign, repeated in all bits.
        above = [*words[1:], b.ashr(words[-1], constant(63, 64))]
        pairs = zip(above, words, strict=True)
        shifted = [b.call(funnel, [high, low, shift]) for high, low in pairs]
        return limbs.join(b, shifted)

    def _float_root(self, x: Value, n: Value) -> Value:
        """Return the n-th root with the operations of `verify.arithmetic.systems.float64`."""
        b, zero, one = self.b, ir.Constant(DOUBLE, 0.0), ir.Constant(DOUBLE, 1.0)
        power = _libm_function(self.module, "pow", 2)
        n = b.sitofp(n, DOUBLE)
        root = b.call(power, [x, b.fdiv(one, n)])
        excess = b.fsub(b.call(power, [root, n]), x)
        slope = b.fmul(n, b.call(power, [root, b.fsub(n, one)]))
        better = b.fsub(root, b.fdiv(excess, slope))
        corrected = b.select(b.fcmp_ordered(">", root, zero), better, root)
        return b.select(b.fcmp_ordered("<", x, zero), ir.Constant(DOUBLE, math.nan), corrected)


def float_function(module: ir.Module, name: str) -> ir.Function:
    """Return the function of one float64 that a source calls by that name, perhaps with the prefix
    `f_`.

    Raises NotImplementedError if it is unknown.
    """
    plain = name.removeprefix("f_")
    if plain in _INTRINSICS:
        return module.declare_intrinsic(f"llvm.{plain}", [DOUBLE])
    if plain not in {*in_rings(), "log1p"}:  # the functions of formulas, and one that kernels use
        raise NotImplementedError(name)
    return _libm_function(module, plain, 1)


def _libm_function(module: ir.Module, name: str, count: int) -> ir.Function:
    """Return the C library's function of that name, of `count` float64."""
    if name not in module.globals:
        ir.Function(module, ir.FunctionType(DOUBLE, [DOUBLE] * count), name)
    return module.globals[name]


def read_number(b: ir.IRBuilder, memory: Value, offset: int, kind: ir.Type) -> tuple[Value, int]:
    """Return the number of that type at a word offset, and the offset behind it."""
    count = 1 if kind == DOUBLE else kind.width // 64
    words = [b.load(b.gep(memory, [constant(offset + i, 64)]), typ=I64) for i in range(count)]
    value = b.bitcast(words[0], DOUBLE) if kind == DOUBLE else limbs.join(b, words)
    return value, offset + count


def write_number(b: ir.IRBuilder, memory: Value, offset: int, value: Value) -> int:
    """Write a number at a word offset; return the offset behind it."""
    if value.type == DOUBLE:
        value = b.bitcast(value, I64)
    count: int = value.type.width // 64
    for i in range(count):
        b.store(limbs.limb(b, value, i), b.gep(memory, [constant(offset + i, 64)]))
    return offset + count
