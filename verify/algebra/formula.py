"""Text to exact expression, by a whitelist over Python's `ast`.

Nothing of the text is ever evaluated as code. What is allowed: the names the caller knows (or any
parameter name), exact numbers, + − * / ** (also written ^), `pi`, and the functions in
`FUNCTIONS`. Decimals are exact: `0.1` is 1/10. Everything else is an InputError.
"""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache

import sympy
from sympy.printing.str import StrPrinter

from verify.algebra.constant_size import FUNCTIONS as NAMES
from verify.algebra.constant_size import within_reach
from verify.algebra.identities.absolute_values import without_absolute_values
from verify.algebra.monomials import DEEPEST, Monomials, is_of_name
from verify.algebra.requirement import Requirement, of_divisor, of_function, of_power
from verify.arithmetic.exact import rational
from verify.errors import InputError, LimitError

MAX_LENGTH = 4000
MAX_DEPTH = 60
MAX_EXPONENT = 64
MAX_NUMBER_BITS = 4000
MAX_ROOT_BITS = 2000  # bits of a number times the index of its root: sympy looks for its factors

FUNCTIONS: dict[str, Callable[[sympy.Expr], sympy.Expr]] = {
    name: getattr(sympy, name) for name in (*NAMES, "sqrt")
}
NOT_SMOOTH = frozenset(
    {"abs", "Abs", "fabs", "sign", "sgn", "floor", "ceil", "round", "trunc", "max", "min"}
)
_NOT_NUMBERS = frozenset({"nan", "NaN", "inf", "Inf", "infinity", "Infinity", "oo"})
RESERVED = frozenset({"p", "q", "h", "t", "pi", *FUNCTIONS, *NOT_SMOOTH, *_NOT_NUMBERS})
_INFINITE = (sympy.nan, sympy.zoo, sympy.oo, -sympy.oo)
_NOT_SMOOTH_NODES = (sympy.Abs, sympy.sign, sympy.Piecewise, sympy.Max, sympy.Min, sympy.floor)
_CHAINS = ((ast.Add, ast.Sub), (ast.Mult, ast.Div))
_APPLY: dict[type, Callable[[sympy.Expr, sympy.Expr], sympy.Expr]] = {
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_SHORT = 18  # digits of a number that is surely within the limits
_DECIMAL = re.compile(r"[0-9.eE+-]+", re.ASCII)
_PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,31}")


@lru_cache(maxsize=256)
def symbol(name: str) -> sympy.Symbol:
    """The one symbol of that name: real, so that √(q²) is |q| and is seen not to be smooth."""
    return sympy.Symbol(name, real=True)


class _Printer(StrPrinter):  # type: ignore[misc]
    """sympy's text form, but for e (a parameter named E?) and for powers that are exponentials."""

    def _print_Exp1(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
        return "exp(1)"

    def _print_Pow(self, expr: sympy.Expr, rational: bool = False) -> str:  # noqa: N802
        if expr.exp.is_Rational:
            return str(super()._print_Pow(expr, rational))
        return f"exp({self._print(expr.exp * sympy.log(expr.base))})"


@lru_cache(maxsize=512)
def to_text(expression: sympy.Expr) -> str:
    """The expression as a formula that `parse` reads back, to an equal expression."""
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
    return read(text, names, source=source)[0]


def read(
    text: str, names: Iterable[str] | None = None, *, source: str = "formula"
) -> tuple[sympy.Expr, list[Requirement]]:
    """As `parse`, with all that what is written asks for to be defined, simplified away or not."""
    if not isinstance(text, str):
        raise InputError(source, text, "is not text; write a formula such as 'p**2/2 + q**2/2'")
    if not text.strip():
        raise InputError(source, text, "empty; write a formula such as p**2/2 + q**2/2")
    if len(text) > MAX_LENGTH:
        raise LimitError(source, text, f"longer than {MAX_LENGTH} characters")
    if not text.isascii():
        raise InputError(source, text, "has a character outside ASCII; write delta for δ")
    line = " ".join(text.replace("^", "**").split())
    if "#" in line or not line.isprintable():
        raise InputError(source, text, "is not a formula: a character in it is not allowed")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's own remarks on the text, such as '1if'
            tree = ast.parse(line, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InputError(source, text, "not a formula; allowed: + - * / ** and functions") from None
    known = None if names is None else frozenset(names)
    reader = _Reader(source, text, line, known)
    result = reader.read(tree, 0)
    if not isinstance(tree, ast.BinOp):
        checked(result, source, text)
    return result, reader.required


def checked(result: sympy.Expr, source: str, text: str) -> sympy.Expr:
    """The expression itself, where it is finite, real, smooth and of bounded size."""
    numbers, powers, others = _by_kind(result)
    if any(isinstance(node, sympy.Abs) for node in others):
        result = without_absolute_values(result)
        numbers, powers, others = _by_kind(result)
    if any(node in _INFINITE or isinstance(node, sympy.AccumBounds) for node in others):
        raise InputError(source, text, "divides by zero, or is not finite: it is not defined")
    if any(isinstance(node, _NOT_SMOOTH_NODES) for node in others):
        raise LimitError(source, text, "is not smooth: the root of an even power is |x|")
    for number in numbers:
        if max(number.p.bit_length(), number.q.bit_length()) > MAX_NUMBER_BITS:
            raise LimitError(source, text, f"a number in it has more than {MAX_NUMBER_BITS} bits")
    for power in powers:
        if power.exp.is_Rational:  # else it is exp(x·log(y)), which sympy writes so
            check_power(power.base, power.exp, source, text)
    logarithms = (node for node in others if isinstance(node, sympy.log))
    if sympy.I in others or any(f.args[0].is_nonpositive for f in logarithms):
        raise InputError(source, text, "is not real, so it is not defined")
    return result


def _by_kind(expression: sympy.Expr) -> tuple[list[sympy.Expr], list[sympy.Expr], list[sympy.Expr]]:
    """The rational numbers, the powers, and what is no sum, product or name, within it."""
    numbers, powers, others = [], [], []
    waiting = [expression]
    while waiting:
        node = waiting.pop()
        if node.is_Rational:
            numbers.append(node)
            continue
        if node.is_Pow:
            powers.append(node)
        elif not (node.is_Add or node.is_Mul or node.is_Symbol):
            others.append(node)
        waiting += node.args
    return numbers, powers, others


def check_power(base: sympy.Expr, exponent: sympy.Expr, source: str, text: str) -> None:
    """InputError where that rational power is not real, or may be too large for sympy."""
    if abs(exponent.p) > MAX_EXPONENT or exponent.q > MAX_EXPONENT:
        raise LimitError(source, text, f"exponent {exponent} beyond ±{MAX_EXPONENT}")
    if exponent.q != 1 and base.is_nonpositive and not base.is_zero:
        raise InputError(source, text, f"is not real, so it is not defined: the root of {base} < 0")
    if exponent.q != 1 and _root_bits(base) * exponent.q > MAX_ROOT_BITS:
        raise LimitError(source, text, "a root of a number in it has too many digits")


def _root_bits(base: sympy.Expr) -> int:
    """Bits of the largest number among its constant factors, times the indices of their roots."""
    constant, _ = base.as_independent(*base.free_symbols, as_Add=False)
    numbers, powers, _ = _by_kind(constant)
    bits = max((max(n.p.bit_length(), n.q.bit_length()) for n in numbers), default=0)
    return bits * math.prod(int(power.exp.q) for power in powers if power.exp.is_Rational)


class _Reader:
    """Turns one syntax tree into an expression; each method takes a node and its depth."""

    def __init__(self, source: str, text: str, line: str, names: frozenset[str] | None) -> None:
        self.source, self.text, self.line, self.names = source, text, line, names
        self.required: list[Requirement] = []

    def fail(self, problem: str) -> InputError:
        return InputError(self.source, self.text, problem)

    def beyond(self, problem: str) -> LimitError:
        return LimitError(self.source, self.text, problem)

    def read(self, node: ast.expr, depth: int) -> sympy.Expr:
        if depth > MAX_DEPTH:
            raise self.beyond(f"nested deeper than {MAX_DEPTH}")
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
        shown = (ast.get_source_segment(self.line, node) or type(node).__name__)[:60]
        raise self.fail(f"{shown!r} is not allowed; allowed: + - * / ** and functions")

    def number(self, node: ast.Constant) -> sympy.Expr:
        # The source text, not node.value: that is already a rounded float.
        written = self.line[node.col_offset : node.end_col_offset]
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            raise self.fail(f"{written!r} is not a number")
        if written.isdecimal() and len(written) <= _SHORT:
            return sympy.Integer(int(written))
        try:
            value = rational(written, self.source)
        except InputError as error:
            known = LimitError if _DECIMAL.fullmatch(written) else InputError
            raise known(error.name, error.value, error.problem) from None
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
            raise self.beyond(f"{name} is not smooth")
        if name not in FUNCTIONS:
            known = hasattr(math, name) or isinstance(getattr(sympy, name, None), type(sympy.sin))
            problem = f"unknown function {name!r}; allowed: {', '.join(sorted(FUNCTIONS))}"
            raise self.beyond(problem) if known else self.fail(problem)
        if len(node.args) != 1 or node.keywords or isinstance(node.args[0], ast.Starred):
            raise self.fail(f"{name} takes one argument")
        argument = self.read(node.args[0], depth + 1)
        self.required += of_function(name, argument)
        # sympy sums and simplifies as it builds: infinities must not get into it.
        if name == "sqrt":
            return self.power(argument, sympy.S.Half)
        if name == "exp" and argument.has(sympy.log):
            return self.finite(self.exponential(argument))
        if not argument.free_symbols and not within_reach(argument):
            raise self.beyond(f"{name} of a constant that is too large, or not defined")
        value = self.finite(self.apply(FUNCTIONS[name], argument, shown=f"{name} of that argument"))
        # sympy turns tan(q + pi/2) into −cot(q), which is not a function of this list.
        return value.replace(sympy.cot, lambda x: 1 / sympy.tan(x))

    def exponential(self, argument: sympy.Expr) -> sympy.Expr:
        """exp of a sum with logarithms: sympy makes powers of them, whose exponents have limits."""
        result = sympy.S.One
        for term in sympy.Add.make_args(argument):
            logs = [f for f in sympy.Mul.make_args(term) if isinstance(f, sympy.log)]
            if len(logs) == 1 and (term / logs[0]).is_Rational:
                result *= self.power(logs[0].args[0], term / logs[0])
            else:
                result *= sympy.exp(term)
        return result

    def operation(self, node: ast.BinOp, depth: int) -> sympy.Expr:
        """A chain of + and −, or of * and /, read from its left end: its length is no depth."""
        if isinstance(node.op, ast.Pow):
            base, exponent = self.read(node.left, depth + 1), self.read(node.right, depth + 1)
            return self.power(base, exponent)
        kinds = next((kinds for kinds in _CHAINS if isinstance(node.op, kinds)), None)
        if kinds is None:
            raise self.fail("an operator is not allowed; allowed: + - * / **")
        chain, first = [node], node.left
        while isinstance(first, ast.BinOp) and isinstance(first.op, kinds):
            chain.append(first)
            first = first.left
        # −a/b reads back as −(a/b), as it is printed.
        minus = ast.Mult in kinds
        if minus and isinstance(first, ast.UnaryOp) and isinstance(first.op, ast.USub):
            first = first.operand
        else:
            minus = False
        if ast.Add in kinds:
            return self.finite(sympy.Add(*self.terms(first, chain, depth)))
        value = self.read(first, depth + 1)
        factors = [(type(step.op), self.read(step.right, depth + 1)) for step in reversed(chain)]
        if value.is_Rational and all(op is ast.Mult and is_of_name(x) for op, x in factors):
            # sympy remembers a product of names, and makes a number times it at once.
            value = value * math.prod((x for _, x in factors[1:]), start=factors[0][1])
            return self.finite(-value if minus else value)
        for op, right in factors:
            if op is ast.Div and right.is_zero:
                raise self.fail("division by zero")
            self.required += of_divisor(right) if op is ast.Div else ()
            value = self.apply(_APPLY[op], value, right, shown="a product or quotient in it")
        return self.finite(-value if minus else value)

    def terms(self, first: ast.expr, chain: list[ast.BinOp], depth: int) -> Iterator[sympy.Expr]:
        """What a chain of + and − sums, to be summed at once as it may be long."""
        signs = [(step.right, -1 if isinstance(step.op, ast.Sub) else 1) for step in chain]
        plain = Monomials(self.line, self.name)
        for node, sign in ((first, 1), *reversed(signs)):
            if depth + DEEPEST >= MAX_DEPTH or not plain.take(node, sign):
                term = self.read(node, depth + 1)
                yield term if sign > 0 else -term
        yield from plain.terms()

    def power(self, base: sympy.Expr, exponent: sympy.Expr) -> sympy.Expr:
        if not exponent.is_Rational:
            raise self.beyond(f"exponent {exponent} must be a rational number; or exp(x*log(y))")
        check_power(base, exponent, self.source, self.text)
        if exponent.q != 1 and not base.free_symbols and not within_reach(base):
            raise self.beyond("a root of a constant that is too large, or not defined")
        if base.is_zero and exponent <= 0:
            raise self.fail("division by zero" if exponent < 0 else "0**0 is not defined")
        self.required += of_power(base, exponent)
        return self.finite(self.apply(operator.pow, base, exponent, shown="a power in it"))

    def apply(
        self, operation: Callable[..., sympy.Expr], *operands: sympy.Expr, shown: str
    ) -> sympy.Expr:
        """What sympy makes of it; sympy fails on a few, such as roots of enormous numbers."""
        try:
            return operation(*operands)
        except (ArithmeticError, AttributeError, TypeError, ValueError, RecursionError):
            raise self.beyond(f"{shown} cannot be handled exactly") from None

    def finite(self, value: sympy.Expr) -> sympy.Expr:
        return checked(value, self.source, self.text)
