"""Limits of exact expressions: they must be finite, real, smooth and of bounded size.

sympy evaluates when it builds an expression: 2**a at a = 10^300, or the sign of
log(sin(exp(exp(a)))) at a = 100, would never end. So powers and constants are checked before sympy
gets them; for constants ball arithmetic tells at once that one is too large. When values are
substituted in an expression, its tree is rebuilt here from its leaves, with the same checks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import flint

from verify.algebra.expressions.function_nodes import function_of
from verify.algebra.expressions.monomials import monomials_of
from verify.arithmetic.flint_precision import working_precision
from verify.effort import answer_unless_long, limit_effort
from verify.errors import InputError, LimitError
from verify.lazy_sympy import sympy

MAX_EXPONENT = 64
MAX_NUMBER_BITS = 4000
MAX_ROOT_BITS = 2000  # for a number's bits times the index of its root: sympy factors the number
MAX_CONSTANT_BITS = 4000  # a constant must be below 2^4000 in size


def check_expression(result: sympy.Expr, source: str, text: str) -> sympy.Expr:
    """Return the expression if it is finite, real, smooth and of bounded size.

    |v| is replaced where v has one sign. Raises InputError or LimitError, which name `source` and
    `text`, for other expressions.
    """
    if _small_polynomial(result):
        return result
    result = _one_product(result)
    numbers, powers, other_nodes = _by_kind(result)
    # sympy makes |x| of √(x²); where x has one sign the root is smooth and the formula allowed.
    if any(isinstance(node, sympy.Abs) for node in other_nodes):
        from verify.algebra.identities.signs import without_absolute_values

        with limit_effort(source, text, "to see the signs in it"):
            result = without_absolute_values(result)
        numbers, powers, other_nodes = _by_kind(result)
    if any(
        node in undefined_values() or isinstance(node, sympy.AccumBounds) for node in other_nodes
    ):
        raise InputError(source, text, "divides by zero, or is not finite: it is not defined")
    if any(_is_not_smooth(node) for node in other_nodes):
        raise LimitError(source, text, "is not smooth: the root of an even power is |x|")
    for number in numbers:
        if max(number.p.bit_length(), number.q.bit_length()) > MAX_NUMBER_BITS:
            raise LimitError(source, text, f"a number in it has more than {MAX_NUMBER_BITS} bits")
    # Powers are checked again here, as sympy may have combined exponents to larger ones.
    for power in powers:
        if power.exp.is_Rational:  # else it is sympy's form of exp(x·log(y))
            check_power(power.base, power.exp, source, text)
    if sympy.I in other_nodes or any(map(_is_of_nonpositive, other_nodes)):
        raise InputError(source, text, "is not real, so it is not defined")
    return result


def undefined_values() -> tuple[sympy.Expr, ...]:
    """Return sympy's values that are infinite or undefined."""
    return sympy.nan, sympy.zoo, sympy.oo, -sympy.oo


def _is_not_smooth(node: sympy.Expr) -> bool:
    """Return True if the node is a function that is not smooth."""
    edged = (sympy.Abs, sympy.sign, sympy.Piecewise, sympy.Max, sympy.Min, sympy.floor)
    return isinstance(node, edged)


def _small_polynomial(x: sympy.Expr) -> bool:
    """Return True if x is a polynomial of several terms with no large number or exponent."""
    terms = monomials_of(x) if x.is_Add else None
    return terms is not None and all(
        max(number.p.bit_length(), number.q.bit_length()) <= MAX_NUMBER_BITS
        and all(n <= MAX_EXPONENT for _, n in powers)
        for number, powers in terms
    )


def _one_product(x: sympy.Expr) -> sympy.Expr:
    """Return x with products flattened, as 2·(−p) to −2·p.

    For √(−p)·√(−p) sympy makes a product within a product, or one with several numbers.
    """
    nested = x.is_Mul and (
        any(factor.is_Mul for factor in x.args) or sum(f.is_Number for f in x.args) > 1
    )
    return sympy.Mul(*x.args) if nested else x


def _by_kind(expression: sympy.Expr) -> tuple[list[sympy.Expr], list[sympy.Expr], list[sympy.Expr]]:
    """Return the rational numbers, the powers, and the nodes that are no sum, product or name."""
    numbers, powers, other_nodes = [], [], []
    waiting = [expression]
    while waiting:
        node = waiting.pop()
        if node.is_Rational:
            numbers.append(node)
            continue
        if node.is_Pow:
            powers.append(node)
        elif not (node.is_Add or node.is_Mul or node.is_Symbol):
            other_nodes.append(node)
        waiting += node.args
    return numbers, powers, other_nodes


def check_power(base: sympy.Expr, exponent: sympy.Expr, source: str, text: str) -> None:
    """Raise InputError if a rational power is not real, LimitError if it may be too large for
    sympy."""
    if abs(exponent.p) > MAX_EXPONENT or exponent.q > MAX_EXPONENT:
        raise LimitError(source, text, f"exponent {exponent} beyond ±{MAX_EXPONENT}")
    if exponent.q != 1 and _is_nonpositive(base) and not base.is_zero:
        raise InputError(source, text, f"is not real, so it is not defined: the root of {base} < 0")
    # sympy tries to factor a number under a root, which takes unbounded time for large ones.
    if exponent.q != 1 and _root_bits(base) * exponent.q > MAX_ROOT_BITS:
        raise LimitError(source, text, "a root of a number in it has too many digits")


def _is_nonpositive(x: sympy.Expr) -> bool:
    return answer_unless_long(lambda: bool(x.is_nonpositive), otherwise=False)


def _is_of_nonpositive(node: sympy.Expr) -> bool:
    """Return True if the node is log, or a function like it, of a nonpositive argument."""
    function = function_of(node)
    if function is None or function.domain is None or function.domain.relation != ">":
        return False
    return _is_nonpositive(function.domain.inside(node.args[0]))


def _root_bits(base: sympy.Expr) -> int:
    """Return the bits of the largest constant factor, times the indices of the roots in it."""
    constant, _ = base.as_independent(*base.free_symbols, as_Add=False)
    numbers, powers, _ = _by_kind(constant)
    bits = max((max(n.p.bit_length(), n.q.bit_length()) for n in numbers), default=0)
    return bits * math.prod(int(power.exp.q) for power in powers if power.exp.is_Rational)


# -- constants ------------------------------------------------------------------------------------


def is_within_reach(constant: sympy.Expr) -> bool:
    """Return True if the constant is finite and below 2^4000 in size, by ball arithmetic."""
    with working_precision(128):
        ball = _ball(constant)
        # 128 bits suffice for the order of magnitude; a ball across the limit counts as too large.
        limit = flint.arb(2) ** MAX_CONSTANT_BITS
        return ball is not None and ball.is_finite() and abs(ball) < limit


def _ball(node: sympy.Expr) -> flint.arb | None:
    """Return a ball around the constant; None if it has a function without balls."""
    if node.is_Rational:
        return flint.arb(flint.fmpq(int(node.p), int(node.q)))
    if node is sympy.pi:
        return flint.arb.pi()
    if node is sympy.E:
        return flint.arb(1).exp()
    balls = [_ball(argument) for argument in node.args]
    arguments = [x for x in balls if x is not None and x.is_finite()]
    if len(arguments) < len(balls):
        return None
    if node.is_Add:
        return sum(arguments, flint.arb(0))
    if node.is_Mul:
        return math.prod(arguments, start=flint.arb(1))
    if node.is_Pow:
        return arguments[0] ** arguments[1]
    function = function_of(node)
    return None if function is None else function.of_balls(flint.arb)(arguments[0])


# -- values for symbols ---------------------------------------------------------------------------


def substitute(
    expression: sympy.Expr, values: Mapping[sympy.Symbol, sympy.Rational], description: str
) -> sympy.Expr:
    """Return the expression with the values in place of the symbols.

    Raises InputError("parameter", description, …) if that fails.
    """
    if not values:
        return expression

    def build(node: sympy.Expr) -> sympy.Expr:
        if node in values:
            return values[node]
        if not node.args or not node.free_symbols & values.keys():
            return node
        arguments = [build(argument) for argument in node.args]
        _check_rebuilding(node, arguments, description)
        try:
            return node.func(*arguments)
        except (ArithmeticError, AttributeError, TypeError, RecursionError):  # sympy's own errors
            raise _problem(description, f"{node} cannot be handled exactly there") from None

    with limit_effort("parameter", description, "to put it in"):
        result = build(expression)
    return check_expression(result, "parameter", description)


def _problem(description: str, text: str) -> InputError:
    return InputError("parameter", description, text)


def _check_rebuilding(node: sympy.Expr, arguments: list[sympy.Expr], description: str) -> None:
    """Raise InputError unless it is safe to rebuild the node from these arguments."""
    exponents = []
    if node.is_Pow and arguments[1].is_Rational:
        check_power(arguments[0], arguments[1], "parameter", description)
    # exp(n log u) becomes uⁿ at once, so n is checked before sympy builds it.
    elif isinstance(node, sympy.exp):  # a sum with logarithms becomes powers
        terms = sympy.Add.make_args(arguments[0])
        exponents = [term.as_coeff_Mul()[0] for term in terms if term.has(sympy.log)]
    if any(e.is_Rational and abs(e) > MAX_EXPONENT for e in exponents):
        raise _problem(description, f"makes an exponent beyond ±{MAX_EXPONENT}")
    constant = isinstance(node, sympy.Function) and not arguments[0].free_symbols
    if constant and not is_within_reach(arguments[0]):
        raise _problem(description, f"{node} is not defined there, or too large")
