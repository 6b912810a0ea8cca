"""One generator of a ring: which function it is, of what, and how it is written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import flint

from verify.algebra.formula import function, symbol
from verify.algebra.identities.polynomials import Poly as Poly
from verify.algebra.identities.polynomials import terms_of as terms_of
from verify.functions import in_rings
from verify.late import sympy


@dataclass(frozen=True)
class Generator:
    """One ring generator: `kind` of function, and its argument.

    `kind`: variable, which has a `name`, pi, a function of `verify.functions.in_rings`, root (of
    `degree`), or inverse.
    """

    index: int
    kind: str
    argument: Poly | None = None
    degree: int = 1
    name: str = ""

    @property
    def inner(self) -> Poly:
        """The argument; of a function, a root, an inverse: not of a variable or π."""
        assert self.argument is not None  # noqa: S101 - the caller looks at the kind
        return self.argument


def generator_expression(g: Generator, argument: sympy.Expr) -> sympy.Expr:
    """The generator's function of an expression, which is not read where it has no argument."""
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
    """A flint rational as sympy's."""
    return sympy.Rational(int(value.numer()), int(value.denom()))
