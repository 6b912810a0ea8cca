"""A kernel's source → LLVM IR in which wide fixed-point numbers and float64 stand side by side.

The source is the small language that `verify.kernels.kernel` writes: assignments, + − * /,
comparisons, calls by name, `if`, one loop `for k in range(steps)`, `return`. A variable's kind is
that of what is first assigned to it, an argument's is its annotation:

- `wide`  (where there is none): a number of the format;
- `sum`   a sum of such numbers, with 64 bits more before the point, so that no sum overflows;
- `float` IEEE double precision; `int` a 64-bit integer.

`wide(x)` takes a float64 but for bits below the last place, `approx(x)` gives one near x; how near,
`verify.arithmetic.wide.newton` says. The name `valid` is true as long as every function had a
value, in all passes of the loop and before it; `inside(x, limit)` is |x| < limit, seen from the
highest limbs, and `shifted(x, s)` is x/2^s.
"""

import ast
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from llvmlite import ir

from verify.arithmetic.wide import limbs, memory
from verify.arithmetic.wide.limbs import I64, Value, constant, resized
from verify.arithmetic.wide.newton import DOUBLE, MoreFunctions, from_double, to_double

Ours: TypeAlias = Any  # a node of a source that we wrote, whose parts are known
BOOL = ir.IntType(1)
FUNCTIONS = ("sin", "cos", "cos_sin", "exp", "log", "sqrt", "sinh", "cosh")
_FLOAT_FUNCTIONS = ("sin", "cos", "exp", "log", "sqrt")
_LIBM_FUNCTIONS = ("log1p", "sinh", "cosh")  # by the C library that this process has
_COMPARE = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}


class Translator:
    """Translates one function; `results` then has the kinds of what it returns."""

    def __init__(self, source: str, width: int, fraction: int, names: Mapping[str, Any]) -> None:
        parsed = ast.parse(source).body[0]
        assert isinstance(parsed, ast.FunctionDef)  # noqa: S101 - our own source
        self.definition, self.fraction, self.names = parsed, fraction, names
        self.module = ir.Module()
        self.functions = MoreFunctions(self.module, width)
        self.types = {"wide": limbs.bits(width), "sum": limbs.bits(width + 64),
                      "float": DOUBLE, "int": I64}  # fmt: skip
        products = sum(isinstance(node, ast.Mult) for node in ast.walk(parsed))
        self.calls_products = self.functions.products.too_many(products)
        self.arguments = [(a.arg, _annotation(a)) for a in parsed.args.args]
        self.results: list[str] = []
        self.returns_tuple = False
        self._variables: dict[str, Value] = {}

    def translate(self) -> ir.Module:
        """The module, with the function as `i64 main(i64* in, i64* out)`."""
        pointer = I64.as_pointer()
        main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), "main")
        self.allocations = ir.IRBuilder(main.append_basic_block("entry"))
        self.b = ir.IRBuilder(main.append_basic_block("body"))
        self._assign("valid", ir.Constant(BOOL, 1))
        offset = 0
        for name, kind in self.arguments:
            value, offset = memory.read(self.b, main.args[0], offset, self.types[kind])
            self._assign(name, value)
        self._block(self.definition.body)
        if not self.b.block.is_terminated:
            self.b.ret_void()
        self.allocations.branch(main.blocks[1])
        return self.module

    def _assign(self, name: str, value: Value) -> None:
        if name not in self._variables:
            self._variables[name] = self.allocations.alloca(value.type, name=name)
        target = self._variables[name].allocated_type
        if value.type != target:
            value = self._to(value, target)
        self.b.store(value, self._variables[name])

    def _require(self, condition: Value) -> None:
        """`valid` only where this is true."""
        self.b.store(self.b.and_(self._load("valid"), condition), self._variables["valid"])

    # -- statements ---------------------------------------------------------------------------

    def _block(self, statements: list[ast.stmt]) -> None:
        for statement in statements:
            known: dict[type, Callable[[Ours], None]] = {
                ast.Assign: self._assignment, ast.If: self._if, ast.For: self._for,
                ast.Return: self._return,
            }  # fmt: skip
            known[type(statement)](statement)

    def _assignment(self, statement: Ours) -> None:
        target = statement.targets[0]
        if hasattr(target, "elts"):
            values = self._call(statement.value)
            for element, value in zip(target.elts, values, strict=True):
                self._assign(element.id, value)
        else:
            self._assign(target.id, self._expression(statement.value))

    def _if(self, statement: ast.If) -> None:
        test = self._condition(statement.test)
        inside = self.b.append_basic_block("then")
        after = self.b.append_basic_block("after")
        self.b.cbranch(test, inside, after)
        self.b.position_at_end(inside)
        self._block(statement.body)
        if not self.b.block.is_terminated:
            self.b.branch(after)
        self.b.position_at_end(after)

    def _for(self, statement: Ours) -> None:
        """`for name in range(limit)`."""
        name, limit = statement.target.id, self._expression(statement.iter.args[0])
        self._assign(name, constant(0, 64))
        head, body, after = (self.b.append_basic_block(n) for n in ("head", "loop", "done"))
        self.b.branch(head)
        self.b.position_at_end(head)
        at = self.b.load(self._variables[name])
        self.b.cbranch(self.b.icmp_signed("<", at, limit), body, after)
        self.b.position_at_end(body)
        self._block(statement.body)
        self._assign(name, self.b.add(at, constant(1, 64)))
        self.b.branch(head)
        self.b.position_at_end(after)

    def _return(self, statement: Ours) -> None:
        value = statement.value
        values = [self._expression(e) for e in value.elts] if isinstance(value, ast.Tuple) else (
            self._call(value) if isinstance(value, ast.Call) else [self._expression(value)]
        )  # fmt: skip
        self.returns_tuple = len(values) > 1 or isinstance(value, ast.Tuple)
        kinds = {str(kind_type): kind for kind, kind_type in self.types.items()}
        self.results = [kinds[str(v.type)] for v in values]
        offset = 0
        for v in values:
            offset = memory.write(self.b, self.b.function.args[1], offset, v)
        memory.write(
            self.b, self.b.function.args[1], offset, resized(self.b, self._load("valid"), 64)
        )
        self.b.ret_void()

    def _load(self, name: str) -> Value:
        return self.b.load(self._variables[name])

    # -- expressions --------------------------------------------------------------------------

    def _expression(self, node: ast.expr) -> Value:
        match node:
            case ast.Name():
                return self._name(node.id)
            case ast.Constant(value=int(value)):
                return constant(value, 64)
            case ast.UnaryOp(op=ast.USub()):
                value = self._expression(node.operand)
                return self.b.fneg(value) if value.type == DOUBLE else self.b.neg(value)
            case ast.BinOp():
                return self._operation(node)
            case ast.Call():
                return self._call(node)[0]
        raise NotImplementedError(ast.dump(node))

    def _name(self, name: str) -> Value:
        if name in self._variables:
            return self._load(name)
        value = self.names[name]
        if isinstance(value, float):
            return ir.Constant(DOUBLE, value)
        return constant(value.raw, self.types["wide"].width)

    def _operation(self, node: ast.BinOp) -> Value:
        x, y = self._expression(node.left), self._expression(node.right)
        x, y = self._alike(x, y)
        b = self.b
        floating = x.type == DOUBLE
        match node.op:
            case ast.Add():
                return b.fadd(x, y) if floating else b.add(x, y)
            case ast.Sub():
                return b.fsub(x, y) if floating else b.sub(x, y)
            case ast.Mult() if floating:
                return b.fmul(x, y)
            case ast.Mult():
                same = ast.dump(node.left) == ast.dump(node.right)
                return self._product(x, x if same else y)
            case ast.Div() if floating:
                return b.fdiv(x, y)
            case ast.Div():
                inverse = self._function("inverse", [y])[0]
                one = isinstance(node.left, ast.Constant) and node.left.value == 1
                return inverse if one else self._product(x, inverse)
        raise NotImplementedError(ast.dump(node))

    def _product(self, x: Value, y: Value) -> Value:
        return self.functions.products.product(self.b, x, y, called=self.calls_products)

    def _alike(self, x: Value, y: Value) -> tuple[Value, Value]:
        """Both in the wider of the two kinds; an integer is taken for what the other is."""
        if x.type == y.type:
            return x, y
        rank = [I64, DOUBLE, self.types["wide"], self.types["sum"]]
        target = max((x.type, y.type), key=rank.index)
        return self._to(x, target), self._to(y, target)

    def _to(self, value: Value, target: ir.Type) -> Value:
        if value.type == target:
            return value
        if value.type == I64 and target == DOUBLE:
            return self.b.sitofp(value, DOUBLE)
        if value.type == I64:
            number = resized(self.b, value, target.width, signed=True)
            return limbs.shifted_up(self.b, number, self.fraction)
        if value.type == self.types["wide"] and target == self.types["sum"]:
            return resized(self.b, value, target.width, signed=True)
        raise TypeError(f"{value.type} is no {target}; use wide(x) or approx(x)")

    def _call(self, node: Ours) -> list[Value]:
        values = [self._expression(a) for a in node.args]
        return self._function(node.func.id, values)

    def _function(self, name: str, values: list[Value]) -> list[Value]:
        b, x = self.b, values[0]
        if name == "abs":
            if x.type == DOUBLE:
                return [b.call(self.module.declare_intrinsic("llvm.fabs", [DOUBLE]), [x])]
            negative = b.icmp_signed("<", x, constant(0, x.type.width))
            return [b.select(negative, b.neg(x), x)]
        if name == "approx":
            return [to_double(b, x, self.fraction)]
        if name == "shifted":
            return [self._shifted(x, values[1])]
        if name == "wide":
            width = self.types["wide"].width
            top = ir.Constant(DOUBLE, 2.0 ** (width - 1 - self.fraction))
            size = b.call(self.module.declare_intrinsic("llvm.fabs", [DOUBLE]), [x])
            self._require(b.fcmp_ordered("<", size, top))
            return [from_double(b, x, width, self.fraction)]
        if x.type == DOUBLE:
            return [self._float_function(name, x)]
        packed = b.call(self.functions.get(name), [x])
        count = len(packed.type.elements) - 1
        self._require(b.extract_value(packed, count))
        return [b.extract_value(packed, i) for i in range(count)]

    def _shifted(self, x: Value, by: Value) -> Value:
        """x / 2^by rounded down, 0 ≤ by < 64: limb by limb, which LLVM does not see by itself."""
        b, count = self.b, x.type.width // 64
        kind = ir.FunctionType(I64, [I64] * 3)
        funnel = self.module.declare_intrinsic("llvm.fshr", [I64], kind)
        words = [limbs.limb(b, x, i) for i in range(count)]
        above = [*words[1:], b.ashr(words[-1], constant(63, 64))]
        moved = [b.call(funnel, [high, low, by]) for high, low in zip(above, words, strict=True)]
        return limbs.joined(b, moved)

    def _float_function(self, name: str, x: Value) -> Value:
        plain = name.removeprefix("f_")
        if plain in _FLOAT_FUNCTIONS:
            return self.b.call(self.module.declare_intrinsic(f"llvm.{plain}", [DOUBLE]), [x])
        if plain not in _LIBM_FUNCTIONS:
            raise NotImplementedError(name)
        if plain not in self.module.globals:
            ir.Function(self.module, ir.FunctionType(DOUBLE, [DOUBLE]), plain)
        return self.b.call(self.module.globals[plain], [x])

    def _condition(self, node: ast.expr) -> Value:
        match node:
            case ast.Name():
                return self._load(node.id)
            case ast.UnaryOp(op=ast.Not()):
                return self.b.not_(self._condition(node.operand))
            case ast.BoolOp():
                join: Callable[[Value, Value], Value] = (
                    self.b.and_ if isinstance(node.op, ast.And) else self.b.or_
                )
                total = self._condition(node.values[0])
                for part in node.values[1:]:
                    total = join(total, self._condition(part))
                return total
            case ast.Compare():
                return self._comparison(node)
            case ast.Call(func=ast.Name(id="inside")):
                return self._inside(*(self._expression(a) for a in node.args))
        raise NotImplementedError(ast.dump(node))

    def _inside(self, x: Value, limit: Value) -> Value:
        """|x| < limit, by the highest limbs alone: where it says so it is so; limit > 0."""
        b, last = self.b, x.type.width // 64 - 1
        x, limit = limbs.limb(b, x, last), limbs.limb(b, limit, last)
        # −limit < x < limit for integers is 0 < x + limit < 2·limit.
        moved = b.sub(b.add(x, limit), constant(1, 64))
        return b.icmp_unsigned("<", moved, b.sub(b.add(limit, limit), constant(1, 64)))

    def _comparison(self, node: ast.Compare) -> Value:
        values = [self._expression(e) for e in (node.left, *node.comparators)]
        total: Value | None = None
        for op, x, y in zip(node.ops, values, values[1:], strict=False):
            x, y = self._alike(x, y)
            compare = self.b.fcmp_ordered if x.type == DOUBLE else self.b.icmp_signed
            part = compare(_COMPARE[type(op)], x, y)
            total = part if total is None else self.b.and_(total, part)
        return total


def _annotation(argument: ast.arg) -> str:
    note = argument.annotation
    return str(note.value) if isinstance(note, ast.Constant) else "wide"
