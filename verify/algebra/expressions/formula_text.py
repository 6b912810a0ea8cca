"""The text of an exact expression as a formula, which `verify.algebra.formula` reads back."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, lru_cache

from verify.lazy_sympy import sympy


@lru_cache(maxsize=512)
def to_text(expression: sympy.Expr) -> str:
    """Format the expression as a formula that `parse` reads back to an equal expression."""
    with _any_length():
        return _printer()(expression)


@cache
def _printer() -> Callable[[sympy.Expr], str]:
    """Return the function that prints an expression. Its class derives from one of sympy's, which
    is imported here."""
    from sympy.printing.str import StrPrinter

    class FormulaPrinter(StrPrinter):  # type: ignore[misc]
        """sympy's text form, except of e (E may be a parameter) and exponential powers."""

        def _print_Exp1(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
            return "exp(1)"

        def _print_Pow(self, expr: sympy.Expr, rational: bool = False) -> str:  # noqa: N802
            if expr.exp.is_Rational:
                return str(super()._print_Pow(expr, rational))
            return f"exp({self._print(expr.exp * sympy.log(expr.base))})"

    return lambda expression: str(FormulaPrinter().doprint(expression))


@contextmanager
def _any_length() -> Iterator[None]:
    """Allow integers of any length as text for a while; Python's limit is 4300 digits.

    That limit guards against numbers from outside. These numbers come from computations: a formula
    may have 10^1000, whose seventh power has 7000 digits.
    """
    # The limit is global to the process, so it is restored even after an error.
    previous_limit = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        yield
    finally:
        sys.set_int_max_str_digits(previous_limit)
