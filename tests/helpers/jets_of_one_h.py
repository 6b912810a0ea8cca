"""Polynomials in the jets, for one H: sympy's derivatives of it in place of the variables."""

from fractions import Fraction
from typing import Any

import flint
import sympy

from tests.helpers.sampled.formulas import P, Q
from verify.algebra.formula import symbol
from verify.algebra.jets import Jets, JetsInDegrees

PLACE = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (5, 8), (4, 9), (-7, 11), (1, 3), (2, 5))]


def at(jets: Jets, x: Any, hamiltonian: sympy.Expr) -> sympy.Expr:
    """In the plane, as a polynomial in p and q."""
    put = {"p": P, "q": Q}
    put |= {
        jets.context.names()[k + 2]: sympy.diff(hamiltonian, P, i, Q, j)
        for k, (i, j) in enumerate(jets.indices)
    }
    terms = (
        sympy.Rational(str(c))
        * sympy.prod(put[jets.context.names()[k]] ** int(n) for k, n in enumerate(m))
        for m, c in x.to_dict().items()
    )
    return sympy.expand(sum(terms, sympy.S.Zero))


def along(y: sympy.Expr, hamiltonian: sympy.Expr) -> sympy.Expr:
    """X y in the plane, by sympy."""
    h_p, h_q = hamiltonian.diff(P), hamiltonian.diff(Q)
    return sympy.expand(h_p * y.diff(Q) - h_q * y.diff(P))


def at_place(jets: JetsInDegrees, x: Any, hamiltonian: sympy.Expr) -> sympy.Rational:
    """In any number of degrees of freedom, at one place, as a number."""
    names, values = [*jets.variables], {}
    for name in names:
        values[name] = value_at_place(symbol(name), names)
    for index, written in zip(jets.indices, jets.context.names()[len(names) :], strict=True):
        if written in str(x):
            own = hamiltonian
            for name, n in zip(names, index, strict=True):
                own = own.diff(symbol(name), n) if n else own
            values[written] = value_at_place(own, names)
    put = {name: flint.fmpq(int(value.p), int(value.q)) for name, value in values.items()}
    return sympy.Rational(str(x.subs(put)))


def value_at_place(expression: sympy.Expr, names: list[str]) -> sympy.Rational:
    """The value of sympy's expression in these names there."""
    put = {symbol(n): sympy.Rational(x.numerator, x.denominator)
           for n, x in zip(names, PLACE, strict=False)}  # fmt: skip
    return sympy.Rational(expression.subs(put))
