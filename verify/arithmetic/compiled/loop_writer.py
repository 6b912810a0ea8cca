"""Plain Python functions over numbers and arrays → LLVM IR.

The language has assignments, also to several names; + − * /, and // % ^ of integers that are not
negative; comparisons, `and`, `or`; `min`, `max`, `sqrt`, `len`; `if`, `while`, `for … in range(…)`,
`break`, `continue`, `return`; and calls of other such functions, which are inlined.

A number is a float64 or a 64-bit integer; a variable keeps the type of its first value. An array
has such numbers, or rows of them; no index is checked. Each operation is rounded as Python rounds
it. Any other source raises NotImplementedError.
"""

import ast
import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import reduce
from math import sqrt
from typing import Any, TypeAlias

from llvmlite import ir

from verify.arithmetic.wide.limbs import I64, Value, constant
from verify.arithmetic.wide.newton import DOUBLE
from verify.arithmetic.wide.one_orbit import float_function, read_number, write_number

Function: TypeAlias = Callable[..., Any]
SourceNode: TypeAlias = Any  # an ast node; its parts are not checked, since we wrote the source
_TYPES = {"float": DOUBLE, "int": I64}
_OPERATIONS = {
    ast.Add: ("add", "fadd"), ast.Sub: ("sub", "fsub"), ast.Mult: ("mul", "fmul"),
    ast.Div: ("", "fdiv"), ast.FloorDiv: ("sdiv", ""), ast.Mod: ("srem", ""),
    ast.BitXor: ("xor", ""),
}  # fmt: skip
_COMPARE = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}


@dataclass(frozen=True)
class Array:
    """An array of rows with `columns` columns; or of numbers, if `columns` is 0."""

    pointer: Value
    length: Value
    columns: int = 0


@dataclass
class Frame:
    """A function that is being written: its variables' addresses, and the blocks it jumps to."""

    names: dict[str, Any]
    globals: dict[str, Any]  # the names of the function's module
    end: ir.Block
    results: list[Value] = field(default_factory=list)  # addresses
    loops: list[tuple[ir.Block, ir.Block]] = field(default_factory=list)  # of continue, of break


class LoopWriter:
    """A writer of a module `void main(i64* in, i64* out)`."""

    def __init__(self) -> None:
        self.module = ir.Module()
        pointer = I64.as_pointer()
        self.main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer] * 2), "main")
        self.allocations = ir.IRBuilder(self.main.append_basic_block("entry"))
        self.b = ir.IRBuilder(self.main.append_basic_block("body"))
        self.frame = Frame({}, {}, self.b.block)

    def write(self, function: Function, kinds: Sequence[str]) -> tuple[str, ...]:
        """Write the function for arguments of these kinds; return the kinds of its results.

        A kind is `float` or `int`; that of an array is followed by its number of columns.
        """
        arguments, offset = [], 0
        for kind, _, columns in (result.partition(" ") for result in kinds):
            read = I64 if columns else _TYPES[kind]
            value, offset = read_number(self.b, self.main.args[0], offset, read)
            if columns:
                length, offset = read_number(self.b, self.main.args[0], offset, I64)
                pointer = self.b.inttoptr(value, _TYPES[kind].as_pointer())
                value = Array(pointer, length, int(columns))
            arguments.append(value)
        results, offset = self._inline(function, arguments), 0
        for result in results:
            offset = write_number(self.b, self.main.args[1], offset, result)
        self.b.ret_void()
        self.allocations.branch(self.main.blocks[1])
        return tuple("float" if x.type == DOUBLE else "int" for x in results)

    def _inline(self, function: Function, arguments: Sequence[Any]) -> list[Value]:
        """Write the function's statements here, and return its results."""
        definition: SourceNode = ast.parse(inspect.getsource(function)).body[0]
        outer = self.frame
        self.frame = Frame({}, function.__globals__, self.b.append_basic_block("end"))
        for argument, value in zip(definition.args.args, arguments, strict=True):
            self._assign(argument.arg, value)
        self._block(definition.body)
        self.b.position_at_end(self.frame.end)
        results = [self.b.load(address) for address in self.frame.results]
        self.frame = outer
        return results

    # -- statements ---------------------------------------------------------------------------

    def _block(self, statements: Sequence[ast.stmt]) -> None:
        for statement in statements:
            handlers: dict[type, Callable[[SourceNode], None]] = {
                ast.Assign: self._assignment, ast.AugAssign: self._change, ast.If: self._if,
                ast.While: self._while, ast.For: self._for, ast.Return: self._return,
                ast.Continue: lambda _: self._go(self.frame.loops[-1][0]),
                ast.Break: lambda _: self._go(self.frame.loops[-1][1]),
                ast.Expr: lambda _: None,  # a docstring
            }  # fmt: skip
            if type(statement) not in handlers:
                raise NotImplementedError(ast.dump(statement))
            handlers[type(statement)](statement)

    def _go(self, block: ir.Block) -> None:
        if not self.b.block.is_terminated:
            self.b.branch(block)

    def _assignment(self, statement: ast.Assign) -> None:
        (target,) = statement.targets
        if isinstance(target, ast.Tuple):
            values = self._several(statement.value, len(target.elts))
            for element, value in zip(target.elts, values, strict=True):
                self._store(element, value)
        else:
            self._store(target, self._expression(statement.value))

    def _change(self, statement: SourceNode) -> None:
        x, y = map(self._expression, (statement.target, statement.value))
        self._store(statement.target, self._operation(statement.op, x, y))

    def _store(self, target: SourceNode, value: Any) -> None:
        if isinstance(target, ast.Name):
            self._assign(target.id, value)
        else:
            address = self._address(target)
            self.b.store(self._as(value, address.type.pointee), address)

    def _assign(self, name: str, value: Any) -> None:
        names = self.frame.names
        if isinstance(value, Array):
            names[name] = value
            return
        if name not in names:
            # Memory is allocated in the entry block: LLVM's sroa turns only that into registers,
            # and a loop that allocated in its body would grow the stack.
            names[name] = self.allocations.alloca(value.type)
        self.b.store(self._as(value, names[name].type.pointee), names[name])

    def _if(self, statement: ast.If) -> None:
        with self.b.if_else(self._condition(statement.test)) as (then, otherwise):
            with then:
                self._block(statement.body)
            with otherwise:
                self._block(statement.orelse)

    def _while(self, statement: ast.While) -> None:
        head = self.b.append_basic_block("head")
        self._go(head)
        self.b.position_at_end(head)
        self._loop(self._condition(statement.test), statement.body, head)

    def _for(self, statement: SourceNode) -> None:
        """Write `for name in range(stop)` or `for name in range(start, stop)`."""
        *start, stop = map(self._expression, statement.iter.args)
        self._assign(statement.target.id, start[0] if start else constant(0, 64))
        head, following = (self.b.append_basic_block(x) for x in ("head", "next"))
        self._go(head)
        self.b.position_at_end(head)
        index = self._expression(ast.Name(statement.target.id))
        self._loop(self._compare("<", index, stop), statement.body, following)
        after = self.b.block
        self.b.position_at_end(following)
        self._assign(statement.target.id, self.b.add(index, constant(1, 64)))
        self._go(head)
        self.b.position_at_end(after)

    def _loop(self, goes_on: Value, body: Sequence[ast.stmt], following: ir.Block) -> None:
        """Write a loop, from its head; `following` is the block that comes after the body."""
        inside, after = (self.b.append_basic_block(x) for x in ("loop", "done"))
        self.b.cbranch(goes_on, inside, after)
        self.b.position_at_end(inside)
        self.frame.loops.append((following, after))
        self._block(body)
        self.frame.loops.pop()
        self._go(following)
        self.b.position_at_end(after)

    def _return(self, statement: SourceNode) -> None:
        frame, values = self.frame, self._several(statement.value, 0)
        if not frame.results:
            frame.results = [self.allocations.alloca(x.type) for x in values]
        for x, address in zip(values, frame.results, strict=True):
            self.b.store(self._as(x, address.type.pointee), address)
        self._go(frame.end)

    # -- expressions --------------------------------------------------------------------------

    def _several(self, node: ast.expr, count: int) -> list[Any]:
        """Return the elements of a tuple, the results of a call, or the first `count` numbers of a
        row; else the one number of the expression."""
        if isinstance(node, ast.Tuple):
            return [self._expression(element) for element in node.elts]
        if isinstance(node, ast.Call):
            return self._call(node)
        value = self._expression(node)
        if not isinstance(value, Array):
            return [value]
        addresses = (self.b.gep(value.pointer, [constant(k, 64)]) for k in range(count))
        return [self.b.load(address) for address in addresses]

    def _expression(self, node: ast.expr) -> Any:
        match node:
            case ast.Name(id=name):
                if name not in self.frame.names:
                    return self._number(self.frame.globals[name])
                value = self.frame.names[name]
                return value if isinstance(value, Array) else self.b.load(value)
            case ast.Constant(value=value):
                return self._number(value)
            case ast.BinOp():
                return self._operation(node.op, *map(self._expression, (node.left, node.right)))
            case ast.Call():
                return self._call(node)[0]
            case ast.Subscript():
                return self._item(node)
        raise NotImplementedError(ast.dump(node))

    def _number(self, value: Any) -> Value:
        return constant(value, 64) if isinstance(value, int) else ir.Constant(DOUBLE, value)

    def _as(self, value: Value, kind: ir.Type) -> Value:
        if value.type == kind:
            return value
        if kind != DOUBLE:
            raise NotImplementedError("a float64 as an integer")
        return self.b.sitofp(value, DOUBLE)

    def _alike(self, x: Value, y: Value) -> tuple[Value, Value]:
        kind = x.type if x.type == y.type else DOUBLE
        return self._as(x, kind), self._as(y, kind)

    def _operation(self, operator: ast.operator, x: Value, y: Value) -> Value:
        x, y = self._alike(x, y)
        name = _OPERATIONS[type(operator)][x.type == DOUBLE]
        if not name:
            raise NotImplementedError(ast.dump(operator))
        return getattr(self.b, name)(x, y)

    def _item(self, node: SourceNode) -> Any:
        array = self._expression(node.value)
        if array.columns and not isinstance(node.slice, ast.Tuple):
            return Array(self._address(node), constant(array.columns, 64))
        return self.b.load(self._address(node))

    def _address(self, node: SourceNode) -> Value:
        """Return the address of a number, or of the beginning of a row."""
        array, indices = self._expression(node.value), [node.slice]
        if isinstance(node.slice, ast.Tuple):
            indices = node.slice.elts
        row, *column = map(self._expression, indices)
        index = self.b.mul(row, constant(array.columns, 64)) if array.columns else row
        index = self.b.add(index, column[0]) if column else index
        return self.b.gep(array.pointer, [index])

    def _call(self, node: SourceNode) -> list[Value]:
        name, values = node.func.id, [self._expression(argument) for argument in node.args]
        if name in ("min", "max"):
            return [reduce(lambda x, y: self._least("<>"[name == "max"], x, y), values)]
        if name == "len":
            return [values[0].length]
        function = self.frame.globals[name]
        if function is sqrt:
            return [self.b.call(float_function(self.module, name), values)]
        return self._inline(function, values)

    def _least(self, order: str, x: Value, y: Value) -> Value:
        """Return the least number for the order "<", the greatest for ">"; of equal ones the first,
        as Python does."""
        x, y = self._alike(x, y)
        return self.b.select(self._compare(order, y, x), y, x)

    def _condition(self, node: ast.expr) -> Value:
        """Write a condition; all of it is evaluated, as nothing in it has side effects."""
        match node:
            case ast.BoolOp(op=operator, values=values):
                join = self.b.and_ if isinstance(operator, ast.And) else self.b.or_
                return reduce(join, map(self._condition, values))
            case ast.Compare(ops=[operator], comparators=[other]):
                x, y = self._expression(node.left), self._expression(other)
                return self._compare(_COMPARE[type(operator)], *self._alike(x, y))
        raise NotImplementedError(ast.dump(node))

    def _compare(self, order: str, x: Value, y: Value) -> Value:
        if x.type != DOUBLE:
            return self.b.icmp_signed(order, x, y)
        compare = self.b.fcmp_unordered if order == "!=" else self.b.fcmp_ordered
        return compare(order, x, y)
