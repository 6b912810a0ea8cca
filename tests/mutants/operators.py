"""What can be changed at one node of a Python syntax tree, each change with a word for it.

Those of the field are in `tests.mutants.of_the_field`: a term, a factor, a square, q for p, a
rounding.
"""

import ast
import copy
from collections.abc import Iterator

from tests.mutants import of_the_field
from tests.mutants.of_the_field import Change, is_text

_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.FloorDiv, ast.LShift: ast.RShift, ast.RShift: ast.LShift,
    ast.BitOr: ast.BitAnd, ast.BitAnd: ast.BitOr,
}  # fmt: skip
_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any"}
_COMMUTE = {"min", "max", "gcd", "lcm", "hypot", "multiply", "multiplied", "mul", "times"}
_ABOUT_TYPES = {"isinstance", "issubclass", "hasattr", "getattr", "setattr", "cast", "TypeVar"}


def changes_of(node: ast.AST) -> Iterator[Change]:
    """All changes at one node, itself and what only it knows of its parts."""
    yield from _of_operation(node)
    yield from _of_condition(node)
    yield from _of_call(node)
    yield from _of_statement(node)
    yield from of_the_field.changes_of(node)
    if isinstance(node, ast.Slice):
        yield from _shifted(node)


def _of_operation(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.BinOp(left, op, right) if type(op) in _ARITHMETIC:
            if not (is_text(left) or is_text(right)):  # texts are put together by + and %
                yield "arithmetic", node, ast.BinOp(left, _ARITHMETIC[type(op)](), right)
        case ast.Compare(left, ops, comparators):
            for k, op in enumerate(ops):
                other = [*ops[:k], _COMPARISONS[type(op)](), *ops[k + 1 :]]
                yield "comparison", node, ast.Compare(left, other, comparators)
        case ast.BoolOp(op, values):
            swapped = ast.Or() if isinstance(op, ast.And) else ast.And()
            yield "and-or", node, ast.BoolOp(swapped, values)
        case ast.UnaryOp(ast.Not(), operand):
            yield "not-dropped", node, operand
        case ast.UnaryOp(ast.USub(), operand):
            yield "minus-dropped", node, operand
        case ast.Constant(bool() as value):
            yield "truth", node, ast.Constant(not value)
        case ast.Constant(int() | float() as value):
            yield from (("constant", node, ast.Constant(value + d)) for d in (1, -1))


def _of_condition(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.If(test) | ast.IfExp(test):
            yield from (("condition", test, ast.Constant(x)) for x in (True, False))
        case ast.While(test):
            yield "condition", test, ast.Constant(False)
        case ast.comprehension(ifs=tests):
            yield from (("condition", test, ast.Constant(True)) for test in tests)
        case ast.match_case(guard=ast.expr() as test):
            yield from (("condition", test, ast.Constant(x)) for x in (True, False))


def _of_call(node: ast.AST) -> Iterator[Change]:
    if not isinstance(node, ast.Call):
        return
    name = called(node)
    if isinstance(node.func, ast.Name) and name in _NAMES:
        yield (
            "min-max",
            node,
            ast.Call(ast.Name(_NAMES[name], ast.Load()), node.args, node.keywords),
        )
    plain = not any(isinstance(a, ast.Starred) for a in node.args)
    if len(node.args) == 2 and plain and name not in _COMMUTE | _ABOUT_TYPES:
        yield "arguments", node, ast.Call(node.func, node.args[::-1], node.keywords)


def called(node: ast.Call) -> str:
    """The last name of what is called; "" where it has none."""
    match node.func:
        case ast.Name(name) | ast.Attribute(attr=name):
            return name
    return ""


def _of_statement(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.AugAssign() | ast.Expr(ast.Call()):
            yield "statement-dropped", node, ast.Pass()
        case ast.FunctionDef(returns=ast.Name("bool")):
            for at in _own_returns(node.body):
                if at.value is not None:
                    yield "return-negated", at.value, ast.UnaryOp(ast.Not(), at.value)
                yield from (("returned", at.value, ast.Constant(x)) for x in (True, False))


def _own_returns(body: list[ast.stmt]) -> Iterator[ast.Return]:
    """The `return`s of a function, without those of functions in it."""
    waiting: list[ast.AST] = list(reversed(body))
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Return):
            yield node
        elif not isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Lambda):
            waiting += reversed(list(ast.iter_child_nodes(node)))


def _shifted(node: ast.Slice) -> Iterator[Change]:
    """A slice's ends moved by one; an open end is moved inwards."""
    lower = _next(node.lower, 1) if node.lower else ast.Constant(1)
    yield "slice", node, ast.Slice(lower, node.upper, node.step)
    upper = _next(node.upper, -1) if node.upper else ast.UnaryOp(ast.USub(), ast.Constant(1))
    yield "slice", node, ast.Slice(node.lower, upper, node.step)


def _next(bound: ast.expr, by: int) -> ast.expr:
    match bound:
        case ast.Constant(int() as value):
            return _number(value + by)
        case ast.UnaryOp(ast.USub(), ast.Constant(int() as value)):
            return _number(-value + by)
    return ast.BinOp(copy.deepcopy(bound), ast.Add() if by > 0 else ast.Sub(), ast.Constant(1))


def _number(value: int) -> ast.expr:
    return ast.Constant(value) if value >= 0 else ast.UnaryOp(ast.USub(), ast.Constant(-value))
