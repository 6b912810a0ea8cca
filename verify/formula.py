"""Text to exact expression, by a whitelist over Python's `ast`.

Nothing of the text is ever evaluated as code. What is allowed: the names the caller knows (or any
parameter name), exact numbers, + − * / ** (also written ^), `pi`, and the functions in
`FUNCTIONS`. Decimals are exact: `0.1` is 1/10. Everything else is an InputError.
"""

import ast
import re
from collections.abc import Callable, Iterable
from typing import Any

import sympy
from sympy.printing.str import StrPrinter

from verify.errors import InputError
from verify.exact import rational

MAX_LENGTH = 4000
MAX_DEPTH = 60
MAX_EXPONENT = 64
MAX_NUMBER_BITS = 4000

FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "sin": sympy.sin,
    "cos": sympy.cos,
    "tan": sympy.tan,
    "exp": sympy.exp,
    "log": sympy.log,
    "sqrt": sympy.sqrt,
    "sinh": sympy.sinh,
    "cosh": sympy.cosh,
    "tanh": sympy.tanh,
    "atan": sympy.atan,
}
NOT_SMOOTH = frozenset(
    {"abs", "Abs", "fabs", "sign", "sgn", "floor", "ceil", "round", "trunc", "max", "min"}
)
RESERVED = frozenset({"p", "q", "h", "t", "pi", *FUNCTIONS, *NOT_SMOOTH})
_NOT_SMOOTH_NODES = (sympy.Abs, sympy.sign, sympy.Piecewise, sympy.Max, sympy.Min, sympy.floor)
_PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,31}")


def symbol(name: str) -> sympy.Symbol:
    """The one symbol of that name: real, so that √(q²) is |q| and is seen not to be smooth."""
    return sympy.Symbol(name, real=True)


class _Printer(StrPrinter):  # type: ignore[misc]
    """sympy's text form, but for e, which would read back as a parameter named E."""

    def _print_Exp1(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
        return "exp(1)"


def to_text(expression: sympy.Expr) -> str:
    """The expression as a formula that `parse` reads back to the same expression."""
    return str(_Printer().doprint(expression))


def parameter_name(name: str) -> str:
    """The name itself, where it may name a parameter; else InputError."""
    if not _PARAMETER.fullmatch(name) or name in RESERVED:
        raise InputError(
            "parameter",
            name,
            "not a parameter name; allowed: a letter, then letters, digits or _,"
            " and none of p q h t pi or a function's name",
        )
    return name


def parse(text: str, names: Iterable[str] | None = None, *, source: str = "formula") -> sympy.Expr:
    """The exact expression that `text` writes.

    `names`: the names that may occur; None allows p, q and any parameter name. `source` is the
    name under which an error speaks of the text. Raises InputError, never anything else.
    """
    if not isinstance(text, str) or not text.strip():
        raise InputError(source, text, "empty; write a formula such as p**2/2 + q**2/2")
    if len(text) > MAX_LENGTH:
        raise InputError(source, text, f"longer than {MAX_LENGTH} characters")
    if not text.isascii():
        raise InputError(source, text, "has a character outside ASCII; write delta for δ")
    line = " ".join(text.replace("^", "**").split())
    try:
        tree = ast.parse(line, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InputError(source, text, "not a formula; allowed: + - * / ** and functions") from None
    known = None if names is None else frozenset(names)
    result = _Reader(source, text, line, known).read(tree, 0)
    return _checked(result, source, text)


def _checked(result: sympy.Expr, source: str, text: str) -> sympy.Expr:
    if result.has(sympy.nan, sympy.zoo, sympy.oo, -sympy.oo):
        raise InputError(source, text, "divides by zero, or is not finite")
    if result.has(sympy.I):
        raise InputError(source, text, "is not real")
    if result.has(*_NOT_SMOOTH_NODES):
        raise InputError(source, text, "is not smooth: the root of an even power is |x|")
    return result


class _Reader:
    """Turns one syntax tree into an expression; each method takes a node and its depth."""

    def __init__(self, source: str, text: str, line: str, names: frozenset[str] | None) -> None:
        self.source, self.text, self.line, self.names = source, text, line, names

    def fail(self, problem: str) -> InputError:
        return InputError(self.source, self.text, problem)

    def read(self, node: ast.expr, depth: int) -> sympy.Expr:
        if depth > MAX_DEPTH:
            raise self.fail(f"nested deeper than {MAX_DEPTH}")
        match node:
            case ast.Constant():
                return self.number(node)
            case ast.Name(id=name):
                return self.name(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.read(operand, depth + 1)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.read(operand, depth + 1)
            case ast.BinOp():
                return self.operation(node, depth)
            case ast.Call():
                return self.call(node, depth)
        shown = ast.get_source_segment(self.line, node) or type(node).__name__
        raise self.fail(f"{shown!r} is not allowed; allowed: + - * / ** and functions")

    def number(self, node: ast.Constant) -> sympy.Expr:
        # The source text, not node.value: that is already a rounded float.
        written = ast.get_source_segment(self.line, node) or ""
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            raise self.fail(f"{written!r} is not a number")
        value = rational(written, self.source)
        return sympy.Rational(value.numerator, value.denominator)

    def name(self, name: str) -> sympy.Expr:
        if name == "pi":
            return sympy.pi
        if name == "t" and (self.names is None or "t" not in self.names):
            raise self.fail("t is not allowed: the Hamiltonian may not depend on time")
        if self.names is not None and name not in self.names:
            raise self.fail(f"unknown name {name!r}; allowed: {', '.join(sorted(self.names))}")
        if self.names is None and name not in ("p", "q"):
            if name in RESERVED:
                raise self.fail(f"{name!r} stands for something else here")
            parameter_name(name)
        return symbol(name)

    def call(self, node: ast.Call, depth: int) -> sympy.Expr:
        name = node.func.id if isinstance(node.func, ast.Name) else "?"
        if name in NOT_SMOOTH:
            raise self.fail(f"{name} is not smooth")
        if name not in FUNCTIONS:
            raise self.fail(f"unknown function {name!r}; allowed: {', '.join(sorted(FUNCTIONS))}")
        if len(node.args) != 1 or node.keywords or isinstance(node.args[0], ast.Starred):
            raise self.fail(f"{name} takes one argument")
        argument = self.read(node.args[0], depth + 1)
        # sympy sums and simplifies as it builds: infinities must not get into it.
        value = self.finite(FUNCTIONS[name](argument))
        # sympy turns tan(q + pi/2) into −cot(q), which is not a function of this list.
        return value.replace(sympy.cot, lambda x: 1 / sympy.tan(x))

    def operation(self, node: ast.BinOp, depth: int) -> sympy.Expr:
        left, right = self.read(node.left, depth + 1), self.read(node.right, depth + 1)
        match node.op:
            case ast.Add():
                return self.finite(left + right)
            case ast.Sub():
                return self.finite(left - right)
            case ast.Mult():
                return self.finite(left * right)
            case ast.Div():
                if right.is_zero:
                    raise self.fail("division by zero")
                return self.finite(left / right)
            case ast.Pow():
                return self.power(left, right)
        raise self.fail("an operator is not allowed; allowed: + - * / **")

    def power(self, base: sympy.Expr, exponent: sympy.Expr) -> sympy.Expr:
        if not exponent.is_Rational:
            raise self.fail(f"exponent {exponent} must be a rational number; write exp(x*log(y))")
        if abs(exponent.p) > MAX_EXPONENT or exponent.q > MAX_EXPONENT:
            raise self.fail(f"exponent {exponent} beyond ±{MAX_EXPONENT}")
        if base.is_zero and exponent <= 0:
            raise self.fail("division by zero" if exponent < 0 else "0**0 is not defined")
        result = self.finite(base**exponent)
        if result.is_Pow and result.exp.is_Rational and abs(result.exp) > MAX_EXPONENT:
            raise self.fail(f"exponent {result.exp} beyond ±{MAX_EXPONENT}")
        return result

    def finite(self, value: sympy.Expr) -> sympy.Expr:
        if value.is_Rational and max(value.p.bit_length(), value.q.bit_length()) > MAX_NUMBER_BITS:
            raise self.fail(f"a number in it has more than {MAX_NUMBER_BITS} bits")
        return _checked(value, self.source, self.text)
