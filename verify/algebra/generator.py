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
    `degree`), inverse, or stage, which is its argument itself under a name, or solved: an unknown
    of a system of equations (see `verify.algebra.implicit_unknowns`), the `degree`-th of it, of
    which its argument is 0.
    """

    index: int
    kind: str
    argument: Poly | None = None
    degree: int = 1
    name: str = ""

    @property
    def inner(self) -> Poly:
        """The argument; of a function, an inverse, a stage, an unknown: not of a variable or π."""
        assert self.argument is not None  # noqa: S101 - the caller looks at the kind
        return self.argument


@dataclass(frozen=True)
class System:
    """Equations F(Z) = 0 of generators Z, solved for; see `verify.algebra.implicit_unknowns`.

    `updates`: (∂F/∂Z)⁻¹ F; `determinants`: of the blocks that are divided by, whose product is
    that of ∂F/∂Z; `starts`: where Newton's method begins; `added_to`: p or q, of which each unknown
    is a change.
    """

    unknowns: tuple[Generator, ...]
    starts: tuple[Poly, ...]
    added_to: tuple[Poly, ...]
    updates: tuple[Poly, ...]
    determinants: tuple[Poly, ...]


def generator_expression(g: Generator, argument: sympy.Expr) -> sympy.Expr:
    """The generator's function of an expression, which is not looked at where it has no argument
    or is an unknown."""
    if g.kind == "variable":
        return symbol(g.name)
    return _FUNCTIONS[g.kind](argument, g.degree)


def _by_name(name: str) -> Callable[[sympy.Expr, int], sympy.Expr]:
    return lambda x, _: function(name)(x)


_FUNCTIONS: dict[str, Callable[[sympy.Expr, int], sympy.Expr]] = {
    **{name: _by_name(name) for name in in_rings()},
    "root": lambda x, degree: x ** sympy.Rational(1, degree),
    "inverse": lambda x, _: 1 / x,
    "stage": lambda x, _: x,
    "pi": lambda x, _: sympy.pi,
    "solved": lambda x, number: sympy.Symbol(f"Z_{number + 1}"),
}


def rational_of(value: flint.fmpq) -> sympy.Rational:
    """A flint rational as sympy's."""
    return sympy.Rational(int(value.numer()), int(value.denom()))
