"""Substitution of parameter values in an expression, with the parser's limits at every step.

sympy evaluates as it rebuilds: 2**a at a = 10^300, or the sign of log(sin(exp(exp(a)))) at a = 100,
would never end. So the tree is rebuilt here from its leaves, and a constant is checked before a
function is applied to it.
"""

from __future__ import annotations

from collections.abc import Mapping

from verify.algebra.expressions.constant_size import is_within_reach
from verify.algebra.limits import MAX_EXPONENT, check_expression, check_power
from verify.effort import limit_effort
from verify.errors import InputError
from verify.late import sympy


def substitute(
    expression: sympy.Expr, values: Mapping[sympy.Symbol, sympy.Rational], description: str
) -> sympy.Expr:
    """Substitute the values in the expression; InputError("parameter", shown, …) if that fails."""
    if not values:
        return expression

    def build(node: sympy.Expr) -> sympy.Expr:
        if node in values:
            return values[node]
        if not node.args or not node.free_symbols & values.keys():
            return node
        arguments = [build(argument) for argument in node.args]
        _check(node, arguments, description)
        try:
            return node.func(*arguments)
        except (ArithmeticError, AttributeError, TypeError, RecursionError):  # from within sympy
            raise _problem(description, f"{node} cannot be handled exactly there") from None

    with limit_effort("parameter", description, "to put it in"):
        result = build(expression)
    return check_expression(result, "parameter", description)


def _problem(description: str, text: str) -> InputError:
    return InputError("parameter", description, text)


def _check(node: sympy.Expr, arguments: list[sympy.Expr], description: str) -> None:
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
