"""Products in a module: written out in place, or functions that are called.

They are rounded to the nearest, so that other ways to form them, in lanes, give the same bits.

Written out they run fastest. But LLVM's time grows like the square of a function's length, and
if products are long or many a call costs little beside: it makes a long kernel a tenth slower,
or a third at most, and compiles it many times sooner.
"""

from collections.abc import Callable

from llvmlite import ir

from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.size import width_of

# What products may add to a kernel that has them write out, in some three instructions; functions
# have theirs called from so many limbs on.
_MOST_IN_KERNEL = 3500
_LEAST_CALLED = 8


class ProductWriter:
    """`limbs.product` and `limbs.high_product` for the numbers of one format."""

    def __init__(self, module: ir.Module, fraction: int) -> None:
        self.module, self.width, self.fraction = module, width_of(fraction), fraction
        self._functions: dict[str, ir.Function] = {}

    def too_many(self, count: int) -> bool:
        """Return True if a kernel of so many products should call them."""
        return count * ((self.width // 64) ** 2 + 4) > _MOST_IN_KERNEL

    def product(self, b: ir.IRBuilder, x: Value, y: Value, *, called: bool | None = None) -> Value:
        """Return x y / 2^fraction, rounded to the nearest."""
        if called is None:
            called = self._long(x)
        return self._call(b, "product", self._product, x, y) if called else self._product(b, x, y)

    def _product(self, b: ir.IRBuilder, x: Value, y: Value) -> Value:
        near = limbs.product(b, x, y, self.fraction)
        if near.unsure is None:
            return near.value
        before, cold = b.block, b.append_basic_block("unsure")
        after = b.append_basic_block("sure")
        b.cbranch(near.unsure, cold, after).set_weights([1, 1 << 20])
        b.position_at_end(cold)
        whole = b.call(self._whole(), [x, y])
        b.branch(after)
        b.position_at_end(after)
        result = b.phi(x.type)
        result.add_incoming(near.value, before)
        result.add_incoming(whole, cold)
        return result

    def _whole(self) -> ir.Function:
        """Return the product from all columns as a function apart, since it is hardly ever
        called."""
        name, kind = f"fixed_whole_product_{self.width}", ir.IntType(self.width)
        if name not in self._functions:
            function = ir.Function(self.module, ir.FunctionType(kind, [kind] * 2), name)
            self._functions[name] = function
            function.linkage = "internal"
            function.attributes.add("noinline")
            inside = ir.IRBuilder(function.append_basic_block("entry"))
            x, y = function.args
            inside.ret(limbs.whole_product(inside, x, y, self.fraction))
        return self._functions[name]

    def high(self, b: ir.IRBuilder, x: Value, y: Value, *, signed: bool = False) -> Value:
        """Return the high half of x y: of fractions their product."""

        def write(b: ir.IRBuilder, x: Value, y: Value) -> Value:
            return limbs.high_product(b, x, y, signed=signed)

        name = "signed_high" if signed else "high"
        return self._call(b, name, write, x, y) if self._long(x) else write(b, x, y)

    def _long(self, x: Value) -> bool:
        return bool(x.type.width >= 64 * _LEAST_CALLED)

    def _call(
        self,
        b: ir.IRBuilder,
        name: str,
        write: Callable[[ir.IRBuilder, Value, Value], Value],
        x: Value,
        y: Value,
    ) -> Value:
        factors = [x] if x is y else [x, y]
        name = f"fixed_{name}_{x.type.width}_{len(factors)}"
        if name not in self._functions:
            kind = ir.FunctionType(x.type, [x.type] * len(factors))
            function = self._functions[name] = ir.Function(self.module, kind, name)
            function.linkage = "internal"
            inside = ir.IRBuilder(function.append_basic_block("entry"))
            inside.ret(write(inside, function.args[0], function.args[-1]))
        return b.call(self._functions[name], factors)
