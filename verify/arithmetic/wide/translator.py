"""A kernel's source → LLVM IR in which wide fixed-point numbers and float64 stand side by side.

The source is in the small language that `verify.kernels.kernel` writes: assignments, + − * /,
comparisons, calls by name, `if`, one loop `for k in range(steps)`, `return`; for one orbit also
loops within that one, and `break`. The kind of a variable is that of its first value, the kind of
an argument its annotation:

- `wide`, or no annotation: a number of the format;
- `sum`: a sum of such numbers, with 64 bits more before the point, so that no sum overflows;
- `float`: IEEE double precision;
- `int`: a 64-bit integer.

`wide(x)` converts a float64 and cuts bits below the last place. `approx(x)` is a float64 near x;
`verify.arithmetic.wide.newton` has the error. `valid` is true as long as every function had a
value, before the loop and in all its passes. `inside(x, limit)` implies |x| < limit; it looks at
the leading bits only. `shifted(x, s)` is x/2^s, rounded down.

A target decides how numbers are represented and how operations are written: for one orbit, or for
one orbit in each lane.
"""

import ast
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import Any, Protocol, TypeAlias

from llvmlite import ir

SourceNode: TypeAlias = Any  # an ast node; its parts are not checked, since we wrote the source
Value: TypeAlias = Any  # a target's representation of a number
KINDS = ("int", "float", "wide", "sum")  # of two operands the earlier kind is converted
_COMPARE = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
_SUMS = {ast.Add: "+", ast.Sub: "-"}


class Target(Protocol):
    """A writer of a module with `void main(i64* in, i64* out)`, operation by operation."""

    module: ir.Module

    def begin(self, arguments: Sequence[tuple[str, str]], products: int) -> None:
        """Write the function's head. `arguments`: (name, kind) of each; `products`: the number of
        multiplications in the source."""

    def end(self) -> None:
        """Write the function's end, if control reaches it."""

    def has(self, name: str) -> bool:
        """Return True if a variable of that name exists; `valid` does, and is true at first."""

    def load(self, name: str) -> Value: ...

    def assign(self, name: str, value: Value) -> None: ...

    def integer(self, value: int) -> Value: ...

    def constant(self, value: Any) -> Value:
        """Return a number of the format, or a float64."""

    def kind(self, value: Value) -> str:
        """Return one of `KINDS`."""

    def convert(self, value: Value, kind: str) -> Value:
        """Convert a number to a later kind of `KINDS`. Raises TypeError if that is impossible."""

    def negative(self, x: Value) -> Value: ...

    def sum(self, sign: str, x: Value, y: Value) -> Value:
        """Return x + y or x − y, both of one kind."""

    def product(self, x: Value, y: Value) -> Value: ...

    def quotient(self, x: Value, y: Value) -> Value:
        """Return the quotient of two float64."""

    def function(self, name: str, values: Sequence[Value]) -> list[Value]:
        """Return the values of a call; if the function has no value, `valid` becomes false for
        good."""

    def compare(self, order: str, x: Value, y: Value) -> Value: ...

    def inside(self, x: Value, limit: Value) -> Value: ...

    def negation(self, condition: Value) -> Value: ...

    def conjunction(self, x: Value, y: Value) -> Value: ...

    def disjunction(self, x: Value, y: Value) -> Value: ...

    def when(self, condition: Value, body: Callable[[], None]) -> None: ...

    def loop(self, name: str, limit: Value, body: Callable[[], None], assigned: set[str]) -> None:
        """Write `for name in range(limit)`; `assigned`: all variables that the body assigns."""

    def leave(self) -> None:
        """Leave the innermost loop. Raises NotImplementedError if some orbits would stay in it."""

    def order(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        """Return a loop's statements in the best order to write them."""

    def give(self, values: Callable[[], Sequence[Value]]) -> None:
        """Write a `return` of the values, and of whether they are valid."""


class Translator:
    """A translator of one function; after `translate`, `results` has the kinds of its results."""

    def __init__(self, source: str, names: Mapping[str, Any], target: Target) -> None:
        parsed = ast.parse(source).body[0]
        assert isinstance(parsed, ast.FunctionDef)  # noqa: S101 - our own source
        self.definition, self.names, self.target = parsed, names, target
        self.arguments = [(a.arg, _annotation(a)) for a in parsed.args.args]
        self.results: list[str] = []
        self.returns_tuple = False

    def translate(self) -> ir.Module:
        """Translate the function, and return the module."""
        products = sum(isinstance(node, ast.Mult) for node in ast.walk(self.definition))
        self.target.begin(self.arguments, products)
        self._block(self.definition.body)
        self.target.end()
        return self.target.module

    # -- statements ---------------------------------------------------------------------------

    def _block(self, statements: list[ast.stmt]) -> None:
        for statement in statements:
            handlers: dict[type, Callable[[SourceNode], None]] = {
                ast.Assign: self._assignment, ast.If: self._if, ast.For: self._for,
                ast.Break: self._break, ast.Return: self._return,
            }  # fmt: skip
            if type(statement) not in handlers:
                raise NotImplementedError(ast.dump(statement))
            handlers[type(statement)](statement)

    def _assignment(self, statement: SourceNode) -> None:
        names = statement.targets
        if hasattr(names[0], "elts"):
            names, values = names[0].elts, self._call(statement.value)
        else:
            values = [self._expression(statement.value)] * len(names)
        for name, value in zip(names, values, strict=True):
            self.target.assign(name.id, value)

    def _if(self, statement: ast.If) -> None:
        # The target decides how: one orbit branches; lanes execute the body, and select its values.
        self.target.when(self._condition(statement.test), lambda: self._block(statement.body))

    def _for(self, statement: SourceNode) -> None:
        """Translate `for name in range(limit)`."""
        assigned = {
            node.id
            for inside in statement.body
            for node in ast.walk(inside)
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
        }
        limit = self._expression(statement.iter.args[0])
        body = self.target.order(statement.body)
        self.target.loop(statement.target.id, limit, lambda: self._block(body), assigned)

    def _break(self, _: SourceNode) -> None:
        self.target.leave()

    def _return(self, statement: SourceNode) -> None:
        value = statement.value

        def values() -> list[Value]:
            if isinstance(value, ast.Tuple):
                results = [self._expression(e) for e in value.elts]
            else:
                call = isinstance(value, ast.Call)
                results = self._call(value) if call else [self._expression(value)]
            self.returns_tuple = len(results) > 1 or isinstance(value, ast.Tuple)
            self.results = [self.target.kind(v) for v in results]
            return results

        self.target.give(values)

    # -- expressions --------------------------------------------------------------------------

    def _expression(self, node: ast.expr) -> Value:
        match node:
            case ast.Name():
                if self.target.has(node.id):
                    return self.target.load(node.id)
                return self.target.constant(self.names[node.id])
            case ast.Constant(value=int(value)):
                return self.target.integer(value)
            case ast.UnaryOp(op=ast.USub()):
                return self.target.negative(self._expression(node.operand))
            case ast.BinOp():
                return self._operation(node)
            case ast.Call():
                return self._call(node)[0]
        raise NotImplementedError(ast.dump(node))

    def _operation(self, node: ast.BinOp) -> Value:
        target = self.target
        x, y = self._alike(self._expression(node.left), self._expression(node.right))
        match node.op:
            case ast.Add() | ast.Sub():
                return target.sum(_SUMS[type(node.op)], x, y)
            case ast.Mult():
                # A square is recognised by its text: it needs only half of the partial products.
                same = ast.dump(node.left) == ast.dump(node.right)
                return target.product(x, x if same else y)
            case ast.Div() if target.kind(x) == "float":
                return target.quotient(x, y)
            case ast.Div():
                # There is no division of wide numbers: x/y is x·(1/y), with two roundings, which
                # the bound of a kernel's rounding counts.
                inverse = target.function("inverse", [y])[0]
                is_inverse = isinstance(node.left, ast.Constant) and node.left.value == 1
                return inverse if is_inverse else target.product(x, inverse)
        raise NotImplementedError(ast.dump(node))

    def _alike(self, x: Value, y: Value) -> tuple[Value, Value]:
        """Return both numbers in the later of their kinds in `KINDS`."""
        kinds = [self.target.kind(v) for v in (x, y)]
        wider = max(kinds, key=KINDS.index)
        x, y = (
            v if kind == wider else self.target.convert(v, wider)
            for v, kind in zip((x, y), kinds, strict=True)
        )
        return x, y

    def _call(self, node: SourceNode) -> list[Value]:
        return self.target.function(node.func.id, [self._expression(a) for a in node.args])

    # -- conditions ---------------------------------------------------------------------------

    def _condition(self, node: ast.expr) -> Value:
        match node:
            case ast.Name():
                return self.target.load(node.id)
            case ast.UnaryOp(op=ast.Not()):
                return self.target.negation(self._condition(node.operand))
            case ast.BoolOp():
                join = (
                    self.target.conjunction
                    if isinstance(node.op, ast.And)
                    else self.target.disjunction
                )
                return reduce(join, map(self._condition, node.values))
            case ast.Compare():
                return self._comparison(node)
            case ast.Call(func=ast.Name(id="inside")):
                x, limit = (self._expression(a) for a in node.args)
                return self.target.inside(x, limit)
        raise NotImplementedError(ast.dump(node))

    def _comparison(self, node: ast.Compare) -> Value:
        values = [self._expression(e) for e in (node.left, *node.comparators)]
        parts = (
            self.target.compare(_COMPARE[type(op)], *self._alike(x, y))
            for op, x, y in zip(node.ops, values, values[1:], strict=False)
        )
        return reduce(self.target.conjunction, parts)


def _annotation(argument: ast.arg) -> str:
    note = argument.annotation
    return str(note.value) if isinstance(note, ast.Constant) else "wide"
