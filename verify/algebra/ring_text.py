"""Ring elements as expressions and as text."""

import re
from typing import TYPE_CHECKING

import sympy

from verify.algebra.formula import to_text
from verify.algebra.generator import Generator, Poly, rational_of, terms_of, written

if TYPE_CHECKING:
    from verify.algebra.ring import Ring

_MOST_FACTORED = 300  # terms, beyond which factoring and sympy take seconds


def as_expression(ring: "Ring", x: Poly, known: dict[int, sympy.Expr]) -> sympy.Expr:
    """x as an expression, its terms as they stand; `known` keeps what its generators became."""
    made = {g.index: g for g in ring.generators}
    terms = []
    for monomial, coefficient in terms_of(x):
        factors = [_of(ring, made[k], known) ** int(n) for k, n in enumerate(monomial) if n]
        terms.append(sympy.Mul(rational_of(coefficient), *factors))
    return sympy.Add(*terms)


def _of(ring: "Ring", g: Generator, known: dict[int, sympy.Expr]) -> sympy.Expr:
    if g.expression is not None:
        return g.expression
    if g.index not in known:
        known[g.index] = written(g, as_expression(ring, g.argument, known))
    return known[g.index]


def as_product(ring: "Ring", x: Poly) -> sympy.Expr:
    """x as an expression, factored into irreducible polynomials in the generators."""
    if x == 0:
        return sympy.Integer(0)
    content, factors = x.factor()
    parts = [ring.expression(f) ** int(n) for f, n in factors]
    return sympy.Mul(rational_of(content), *parts)


def as_text(ring: "Ring", x: Poly) -> str:
    """x as a formula: factored where it has few terms, else as it stands in the ring."""
    if len(x) <= _MOST_FACTORED:
        return to_text(as_product(ring, x))
    made = {f"_{g.index}": f"({to_text(_of(ring, g, {}))})" for g in ring.used(x)}
    return re.sub(r"\b_\d+\b", lambda name: made[name[0]], str(x)).replace("^", "**")
