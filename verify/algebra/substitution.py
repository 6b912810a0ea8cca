"""Putting parameter values into an expression, with the parser's limits at every step.

sympy evaluates as it rebuilds: 2**a at a = 10^300, or the sign of log(sin(exp(exp(a)))) at a = 100,
would never end. So the tree is rebuilt here from its leaves, and a constant is looked at before a
function of it is made.
"""

from __future__ import annotations

from collections.abc import Mapping

from verify.algebra.expressions.constant_size import within_reach
from verify.algebra.limits import MAX_EXPONENT, check_power, checked
from verify.effort import limited
from verify.errors import InputError
from verify.late import sympy


def substitute(
    expression: sympy.Expr, values: Mapping[sympy.Symbol, sympy.Rational], shown: str
) -> sympy.Expr:
    """The expression with the values put in; InputError("parameter", shown, …) where that fails."""
    if not values:
        return expression

    def build(node: sympy.Expr) -> sympy.Expr:
        if node in values:
            return values[node]
        if not node.args or not node.free_symbols & values.keys():
            return node
        arguments = [build(argument) for argument in node.args]
        _check(node, arguments, shown)
        try:
            return node.func(*arguments)
        except (ArithmeticError, AttributeError, TypeError, RecursionError):  # from within sympy
            raise _problem(shown, f"{node} cannot be handled exactly there") from None

    with limited("parameter", shown, "to put it in"):
        put = build(expression)
    return checked(put, "parameter", shown)


def _problem(shown: str, text: str) -> InputError:
    return InputError("parameter", shown, text)


def _check(node: sympy.Expr, arguments: list[sympy.Expr], shown: str) -> None:
    """Whether rebuilding the node of these arguments is safe."""
    exponents = []
    if node.is_Pow and arguments[1].is_Rational:
        check_power(arguments[0], arguments[1], "parameter", shown)
    elif isinstance(node, sympy.exp):  # a sum with logarithms becomes powers
        terms = sympy.Add.make_args(arguments[0])
        exponents = [term.as_coeff_Mul()[0] for term in terms if term.has(sympy.log)]
    if any(e.is_Rational and abs(e) > MAX_EXPONENT for e in exponents):
        raise _problem(shown, f"makes an exponent beyond ±{MAX_EXPONENT}")
    constant = isinstance(node, sympy.Function) and not arguments[0].free_symbols
    if constant and not within_reach(arguments[0]):
        raise _problem(shown, f"{node} is not defined there, or too large")
