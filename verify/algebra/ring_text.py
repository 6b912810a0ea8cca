"""Ring elements as expressions and as text."""

import re

import sympy

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.formula import to_text
from verify.algebra.generator import Generator, Poly, generator_expression, rational_of, terms_of

_MOST_FACTORED = 300  # terms, beyond which factoring and sympy take seconds


def as_expression(ring: DifferentialRing, x: Poly) -> sympy.Expr:
    """x as an expression, its terms as they stand in the ring."""
    generators = {g.index: g for g in ring.generators}
    terms = []
    for monomial, coefficient in terms_of(x):
        factors = [_of(ring, generators[k]) ** int(n) for k, n in enumerate(monomial) if n]
        terms.append(sympy.Mul(rational_of(coefficient), *factors))
    return sympy.Add(*terms)


def _of(ring: DifferentialRing, g: Generator) -> sympy.Expr:
    """The generator as an expression, made once for each ring."""
    if g.expression is not None:
        return g.expression
    if g.index not in ring.expressions:
        ring.expressions[g.index] = generator_expression(g, as_expression(ring, g.inner))
    return ring.expressions[g.index]


def as_product(ring: DifferentialRing, x: Poly) -> sympy.Expr:
    """x as an expression, factored into irreducible polynomials in the generators."""
    if x.is_zero():
        return sympy.Integer(0)
    content, factors = x.factor()
    parts = [as_expression(ring, f) ** int(n) for f, n in factors]
    return sympy.Mul(rational_of(content), *parts)


def as_text(ring: DifferentialRing, x: Poly) -> str:
    """x as a formula: factored where it has few terms, else as it stands in the ring."""
    if len(x) <= _MOST_FACTORED:
        return to_text(as_product(ring, x))
    names = {f"_{g.index}": f"({to_text(_of(ring, g))})" for g in ring.generators_in(x)}
    return re.sub(r"\b_\d+\b", lambda name: names[name[0]], str(x)).replace("^", "**")
