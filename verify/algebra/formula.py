"""The parser of formulas: text to exact expression, by a whitelist over Python's `ast`.

The text is never evaluated as code. Allowed are the caller's names (or any parameter name), exact
numbers, + − * / ** (also written ^), `pi`, and the functions in `FUNCTIONS`. Decimals are exact:
`0.1` is 1/10. Everything else raises InputError.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Iterable
from functools import lru_cache
from types import ModuleType

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.expressions.function_nodes import (
    Requirement,
    requirements_of_divisor,
    requirements_of_function,
    requirements_of_power,
)
from verify.algebra.expressions.monomials import MAX_NESTING, Monomials, is_power_of_name
from verify.algebra.limits import check_expression, check_power, is_within_reach
from verify.arithmetic.exact import rational
from verify.effort import limit_effort
from verify.errors import InputError, LimitError
from verify.functions import names as names_of_functions
from verify.lazy_sympy import sympy

MAX_LENGTH = 5000  # characters; the H of a chain of 64 masses has 4,240
MAX_DEPTH = 60

FUNCTIONS = names_of_functions()
NOT_SMOOTH = frozenset(
    {"abs", "Abs", "fabs", "sign", "sgn", "floor", "ceil", "round", "trunc", "max", "min"}
)
_NOT_NUMBERS = frozenset({"nan", "NaN", "inf", "Inf", "infinity", "Infinity", "oo"})
RESERVED = frozenset({"p", "q", "h", "t", "pi", *FUNCTIONS, *NOT_SMOOTH, *_NOT_NUMBERS})
_CHAINS = ((ast.Add, ast.Sub), (ast.Mult, ast.Div))
_APPLY: dict[type, Callable[[sympy.Expr, sympy.Expr], sympy.Expr]] = {
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_is_zero = operator.attrgetter("is_zero")
_SHORT_DIGITS = 18  # an integer with so many digits is surely within the limits
_DECIMAL = re.compile(r"[0-9.eE+-]+", re.ASCII)
_PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,31}")


@lru_cache(maxsize=256)
def symbol(name: str) -> sympy.Symbol:
    """Return the symbol of that name: it is real, so √(q²) becomes |q|, which is not smooth."""
    return sympy.Symbol(name, real=True)


def function(name: str) -> Callable[[sympy.Expr], sympy.Expr]:
    """Return the function of that name, one of `FUNCTIONS`."""
    sympy_function: Callable[[sympy.Expr], sympy.Expr] = getattr(sympy, name)
    return sympy_function


def parameter_name(name: str) -> str:
    """Return the name if it may name a parameter; else raise InputError."""
    if not name.isascii():
        from verify.algebra.text_mistakes import strange_character

        raise InputError("parameter", name, strange_character(name))
    if not _PARAMETER.fullmatch(name) or name in RESERVED:
        raise InputError(
            "parameter",
            name,
            "not a parameter name; allowed: a letter, then letters, digits or _,"
            " and none of p q h t pi or a function's name",
        )
    return name


def parse(text: str, names: Iterable[str] | None = None, *, source: str = "formula") -> sympy.Expr:
    """Parse `text` to an exact expression.

    `names`: the names that may occur; None allows p, q, t and any parameter name. `source`: what
    the text is called in an error message. Raises InputError, and no other exception.
    """
    return read(text, names, source=source)[0]


def read(
    text: str, names: Iterable[str] | None = None, *, source: str = "formula"
) -> tuple[sympy.Expr, list[Requirement]]:
    """Parse `text`; return the expression, and the requirements for the text to be defined.

    These include requirements of parts that sympy's simplification removes; see
    `verify.algebra.expressions.function_nodes`. The arguments are those of `parse`.
    """
    if not isinstance(text, str):
        raise InputError(source, text, "is not text; write a formula such as 'p**2/2 + q**2/2'")
    if not text.strip():
        raise InputError(source, text, "empty; write a formula such as p**2/2 + q**2/2")
    if len(text) > MAX_LENGTH:
        raise LimitError(source, text, f"longer than {MAX_LENGTH} characters")
    if not (text.isascii() and " ".join(text.split()).isprintable()):
        from verify.algebra.text_mistakes import strange_character

        raise InputError(source, text, strange_character(text))
    line = " ".join(text.replace("^", "**").split())
    tree = _tree(line, text, source)
    allowed_names = None if names is None else frozenset(names)
    reader = _Reader(source, text, line, allowed_names)
    result = reader.read(tree, 0)
    if not isinstance(tree, ast.BinOp):
        check_expression(result, source, text)
    return result, reader.required


def _tree(line: str, text: str, source: str) -> ast.expr:
    offset = None
    try:
        if "#" not in line:  # Python would skip the rest of the line as a comment
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # Python warns of texts such as '1if'
                return ast.parse(line, mode="eval").body
    except SyntaxError as error:
        offset = error.offset and error.offset - 1
    except (ValueError, RecursionError, MemoryError):
        pass
    from verify.algebra.text_mistakes import syntax_mistake

    raise InputError(source, text, syntax_mistake(text, FUNCTIONS, offset))


def _nodes() -> ModuleType:
    """Return the module of messages about mistakes, which is imported only for a mistake."""
    from verify.algebra import node_mistakes

    return node_mistakes


class _Reader:
    """A reader of one syntax tree into an expression; most methods take a node and its depth."""

    def __init__(self, source: str, text: str, line: str, names: frozenset[str] | None) -> None:
        self.source, self.text, self.line, self.names = source, text, line, names
        self.required: list[Requirement] = []
        self.effort = limit_effort(source, text, "to read it")

    def fail(self, problem: str, position: ast.expr | int | None = None) -> InputError:
        return InputError(self.source, self.text, self.with_place(problem, position))

    def exceed_limit(self, problem: str, at: ast.expr | None = None) -> LimitError:
        return LimitError(self.source, self.text, self.with_place(problem, at))

    def with_place(self, problem: str, position: ast.expr | int | None) -> str:
        """Prefix the problem with the place in the text of a node, or of an offset in the line."""
        if position is None:
            return problem
        from verify.algebra.text_mistakes import format_place, index_of

        offset = position if isinstance(position, int) else position.col_offset
        return f"at {format_place(self.text, index_of(self.text, offset))}: {problem}"

    def read(self, node: ast.expr, depth: int) -> sympy.Expr:
        if depth > MAX_DEPTH:
            raise self.exceed_limit(f"nested deeper than {MAX_DEPTH}")
        match node:
            case ast.Constant():
                return self.number(node)
            case ast.Name(id=name):
                return self.name(name, node)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.read(operand, depth + 1)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.read(operand, depth + 1)
            case ast.BinOp():
                return self.operation(node, depth)
            case ast.Call():
                return self.call(node, depth)
        raise self.fail(
            _nodes().not_allowed(node, self.line, FUNCTIONS), _nodes().stop_of(node, self.line)
        )

    def number(self, node: ast.Constant) -> sympy.Expr:
        # The text is read, not node.value, which is a rounded float.
        digits = self.line[node.col_offset : node.end_col_offset]
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            raise self.fail(_nodes().no_number(node.value, digits), node)
        if digits.isdecimal() and len(digits) <= _SHORT_DIGITS:
            return sympy.Integer(int(digits))
        try:
            value = rational(digits, self.source)
        except InputError as error:
            refuse = self.exceed_limit if _DECIMAL.fullmatch(digits) else self.fail
            raise refuse(f"{digits[:40]}: {error.problem}", node) from None
        return sympy.Rational(value.numerator, value.denominator)

    def name(self, name: str, at: ast.expr | None = None) -> sympy.Expr:
        if name == "pi":
            return sympy.pi
        if self.names is not None and name not in self.names:
            raise self.fail(_nodes().unknown_name(name, self.names, FUNCTIONS), at)
        if self.names is None and name not in ("p", "q", "t"):
            if name in RESERVED:
                raise self.fail(_nodes().reserved_name(name, FUNCTIONS), at)
            parameter_name(name)
        return symbol(name)

    def call(self, node: ast.Call, depth: int) -> sympy.Expr:
        name = node.func.id if isinstance(node.func, ast.Name) else "?"
        if name in NOT_SMOOTH:
            listed = ", ".join(sorted(FUNCTIONS))
            raise self.exceed_limit(f"{name} is not smooth, and H must be; allowed: {listed}", node)
        if name not in FUNCTIONS:
            is_in_library = hasattr(math, name) or isinstance(
                getattr(sympy, name, None), type(sympy.sin)
            )
            problem = _nodes().unknown_function(node, self.line, FUNCTIONS)
            raise self.exceed_limit(problem, node) if is_in_library else self.fail(problem, node)
        if len(node.args) != 1 or node.keywords or isinstance(node.args[0], ast.Starred):
            raise self.fail(_nodes().wrong_arguments(name, node, self.line), node)
        argument = self.read(node.args[0], depth + 1)
        self.required += requirements_of_function(name, argument)
        # A root is a power here, so that it has the same limits as u**(1/2).
        if name == "sqrt":
            return self.power(argument, sympy.S.Half)
        if name == "exp" and argument.has(sympy.log):  # sympy makes powers of it: they have limits
            return self.finite(self.exponential(argument))
        if not argument.free_symbols and not is_within_reach(argument):
            raise self.exceed_limit(f"{name} of a constant that is too large, or not defined")
        value = self.finite(
            self.apply(function(name), argument, description=f"{name} of that argument")
        )
        # sympy turns tan(q + pi/2) into −cot(q), and cot is not among the functions.
        return value.replace(sympy.cot, lambda x: 1 / sympy.tan(x))

    def exponential(self, argument: sympy.Expr) -> sympy.Expr:
        """Return exp of a sum with logarithms, which become powers with limited exponents."""
        result = sympy.S.One
        for term in sympy.Add.make_args(argument):
            logs = [f for f in sympy.Mul.make_args(term) if isinstance(f, sympy.log)]
            if len(logs) == 1 and (term / logs[0]).is_Rational:
                result *= self.power(logs[0].args[0], term / logs[0])
            else:
                result *= sympy.exp(term)
        return result

    def operation(self, node: ast.BinOp, depth: int) -> sympy.Expr:
        """Read a power, or a chain of + and − or of * and / from its left end; the length of a
        chain does not count as depth."""
        if isinstance(node.op, ast.Pow):
            base, exponent = self.read(node.left, depth + 1), self.read(node.right, depth + 1)
            return self.power(base, exponent, node.right)
        kinds = next((kinds for kinds in _CHAINS if isinstance(node.op, kinds)), None)
        if kinds is None:
            raise self.fail(_nodes().operator_not_allowed(node), _nodes().stop_of(node, self.line))
        chain, first = [node], node.left
        while isinstance(first, ast.BinOp) and isinstance(first.op, kinds):
            chain.append(first)
            first = first.left
        if ast.Add in kinds:
            return self.finite(self.sum(first, chain, depth))
        minus = False
        if isinstance(first, ast.UnaryOp) and isinstance(first.op, ast.USub):
            minus, first = True, first.operand  # −a/b is read as −(a/b), which prints as −a/b
        value = self.read(first, depth + 1)
        factors = [(type(step.op), self.read(step.right, depth + 1)) for step in reversed(chain)]
        if value.is_Rational and all(op is ast.Mult and is_power_of_name(x) for op, x in factors):
            # sympy caches a product of names; then a number times it is fast.
            value = value * math.prod((x for _, x in factors[1:]), start=factors[0][1])
            return self.finite(-value if minus else value)
        for (op, right), step in zip(factors, reversed(chain), strict=True):
            if op is ast.Div and self.apply(_is_zero, right, description="a divisor in it"):
                raise self.fail("division by zero", step.right)
            self.required += requirements_of_divisor(right) if op is ast.Div else ()
            value = self.apply(_APPLY[op], value, right, description="a product or quotient in it")
        return self.finite(-value if minus else value)

    def sum(self, first: ast.expr, chain: list[ast.BinOp], depth: int) -> sympy.Expr:
        """Read the terms of a chain of + and −, and add them all at once, since it may be long."""
        signs = [(step.right, -1 if isinstance(step.op, ast.Sub) else 1) for step in chain]
        plain, others = Monomials(self.line, self.name), []
        for node, sign in ((first, 1), *reversed(signs)):
            if depth + MAX_NESTING >= MAX_DEPTH or not plain.take(node, sign):
                term = self.read(node, depth + 1)
                others.append(term if sign > 0 else -term)
        return sympy.Add(*others, plain.sum())

    def power(
        self, base: sympy.Expr, exponent: sympy.Expr, node: ast.expr | None = None
    ) -> sympy.Expr:
        if not exponent.is_Rational:
            raise self.exceed_limit(
                _nodes().exponent_with_names(to_text(base), to_text(exponent)), node
            )
        check_power(base, exponent, self.source, self.text)
        if exponent.q != 1 and not base.free_symbols and not is_within_reach(base):
            raise self.exceed_limit("a root of a constant that is too large, or not defined")
        if exponent <= 0 and self.apply(_is_zero, base, description="a power in it"):
            raise self.fail("division by zero" if exponent < 0 else "0**0 is not defined")
        self.required += requirements_of_power(base, exponent)
        return self.finite(self.apply(operator.pow, base, exponent, description="a power in it"))

    def apply(
        self, operation: Callable[..., sympy.Expr], *operands: sympy.Expr, description: str
    ) -> sympy.Expr:
        """Apply an operation of sympy; LimitError if it fails, as for roots of huge numbers."""
        with self.effort:
            try:
                return operation(*operands)
            except (ArithmeticError, AttributeError, TypeError, ValueError, RecursionError):
                raise self.exceed_limit(f"{description} cannot be handled exactly") from None

    def finite(self, value: sympy.Expr) -> sympy.Expr:
        return check_expression(value, self.source, self.text)
