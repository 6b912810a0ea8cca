"""The text of an exact expression as a formula, which `verify.algebra.formula` reads back."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

from verify.late import sympy


@lru_cache(maxsize=512)
def to_text(expression: sympy.Expr) -> str:
    """Format the expression as a formula that `parse` reads back to an equal expression."""
    from verify.algebra.expressions.formula_printer import FormulaPrinter  # which imports sympy

    with _any_length():
        return str(FormulaPrinter().doprint(expression))


@contextmanager
def _any_length() -> Iterator[None]:
    """Allow whole numbers of any length as text; Python's own limit is 4300 digits.

    That limit guards against numbers from outside. These come from within: 10^1000, which a formula
    may hold, has 7000 digits in its seventh power.
    """
    # The limit is global to the process, so it is restored even after an error.
    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        yield
    finally:
        sys.set_int_max_str_digits(before)
