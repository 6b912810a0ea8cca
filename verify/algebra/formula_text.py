"""Exact expression → the text of a formula, which `verify.algebra.formula` reads back."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

import sympy
from sympy.printing.str import StrPrinter


@lru_cache(maxsize=512)
def to_text(expression: sympy.Expr) -> str:
    """The expression as a formula that `parse` reads back, to an equal expression."""
    with _any_length():
        return str(_Printer().doprint(expression))


class _Printer(StrPrinter):  # type: ignore[misc]
    """sympy's text form, but for e (a parameter named E?) and for powers that are exponentials."""

    def _print_Exp1(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
        return "exp(1)"

    def _print_Pow(self, expr: sympy.Expr, rational: bool = False) -> str:  # noqa: N802
        if expr.exp.is_Rational:
            return str(super()._print_Pow(expr, rational))
        return f"exp({self._print(expr.exp * sympy.log(expr.base))})"


@contextmanager
def _any_length() -> Iterator[None]:
    """Whole numbers are written in it however long they are; Python writes 4300 digits at most.

    That is for numbers that come from outside. These do not: 10^1000, which a formula may hold,
    has 7000 digits in its seventh power.
    """
    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        yield
    finally:
        sys.set_int_max_str_digits(before)
