"""Products of fixed-point numbers in a module: inlined, or functions that are called.

They are rounded to the nearest, so that products in lanes, which are formed otherwise, have the
same bits.

Inlined products run fastest. But LLVM's time grows like the square of a function's length. For long
or many products calls cost little: they make a long kernel a tenth slower, at most a third, and
compile it many times sooner.
"""

from collections.abc import Callable

from llvmlite import ir

from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import Value
from verify.arithmetic.wide.size import width_of

# A kernel may inline products up to this cost, in units of some three instructions; the functions
# call theirs from `_MIN_CALLED_LIMBS` limbs on.
_MAX_KERNEL_COST = 3500
_MIN_CALLED_LIMBS = 8


class ProductWriter:
    """A writer of `limbs.product` and `limbs.high_product` for the numbers of one format."""

    def __init__(self, module: ir.Module, fraction: int) -> None:
        self.module, self.width, self.fraction = module, width_of(fraction), fraction
        self._functions: dict[str, ir.Function] = {}

    def too_many(self, count: int) -> bool:
        """Return True if a kernel with `count` products should call them."""
        return count * ((self.width // 64) ** 2 + 4) > _MAX_KERNEL_COST

    def product(self, b: ir.IRBuilder, x: Value, y: Value, *, called: bool | None = None) -> Value:
        """Return x y / 2^fraction, rounded to the nearest. `called`: by a call, not inlined; None:
        as the length of x demands."""
        if called is None:
            called = self._long(x)
        return self._call(b, "product", self._product, x, y) if called else self._product(b, x, y)

    def _product(self, b: ir.IRBuilder, x: Value, y: Value) -> Value:
        near = limbs.product(b, x, y, self.fraction)
        if near.unsure is None:
            return near.value
        entry, cold = b.block, b.append_basic_block("unsure")
        after = b.append_basic_block("sure")
        b.cbranch(near.unsure, cold, after).set_weights([1, 1 << 20])
        b.position_at_end(cold)
        whole = b.call(self._whole(), [x, y])
        b.branch(after)
        b.position_at_end(after)
        result = b.phi(x.type)
        result.add_incoming(near.value, entry)
        result.add_incoming(whole, cold)
        return result

    def _whole(self) -> ir.Function:
        """Return the function for the product from all columns; it is not inlined, since it is
        hardly ever called."""
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
        """Return the high half of x y: the product, if x and y are fractions."""

        def write(b: ir.IRBuilder, x: Value, y: Value) -> Value:
            return limbs.high_product(b, x, y, signed=signed)

        name = "signed_high" if signed else "high"
        return self._call(b, name, write, x, y) if self._long(x) else write(b, x, y)

    def _long(self, x: Value) -> bool:
        return bool(x.type.width >= 64 * _MIN_CALLED_LIMBS)

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
