"""Exact expression → the text of a formula, which `verify.algebra.formula` reads back."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

from verify.late import sympy


@lru_cache(maxsize=512)
def to_text(expression: sympy.Expr) -> str:
    """The expression as a formula that `parse` reads back, to an equal expression."""
    from verify.algebra.expressions.formula_printer import FormulaPrinter  # which imports sympy

    with _any_length():
        return str(FormulaPrinter().doprint(expression))


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
