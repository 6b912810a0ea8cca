"""The expression of a ring's generator: its function of an argument."""

from __future__ import annotations

from collections.abc import Callable

import flint

from verify.algebra.formula import function, symbol
from verify.algebra.identities.polynomials import Generator as Generator
from verify.algebra.identities.polynomials import Poly as Poly
from verify.algebra.identities.polynomials import terms_of as terms_of
from verify.functions import in_rings
from verify.late import sympy


def generator_expression(g: Generator, argument: sympy.Expr) -> sympy.Expr:
    """Apply the generator's function to an expression, which is ignored by a variable and π."""
    if g.kind == "variable":
        return symbol(g.name)
    return _FUNCTIONS[g.kind](argument, g.degree)


def _by_name(name: str) -> Callable[[sympy.Expr, int], sympy.Expr]:
    return lambda x, _: function(name)(x)


_FUNCTIONS: dict[str, Callable[[sympy.Expr, int], sympy.Expr]] = {
    **{name: _by_name(name) for name in in_rings()},
    "root": lambda x, degree: x ** sympy.Rational(1, degree),
    "inverse": lambda x, _: 1 / x,
    "pi": lambda x, _: sympy.pi,
}


def rational_of(value: flint.fmpq) -> sympy.Rational:
    """Convert a flint rational to sympy's."""
    return sympy.Rational(int(value.numer()), int(value.denom()))
