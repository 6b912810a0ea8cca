"""Ring elements as expressions and as text."""

from __future__ import annotations

import re
from collections.abc import Mapping

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.generator import Generator, Poly, generator_expression, rational_of, terms_of
from verify.algebra.identities.polynomials import places_in
from verify.algebra.limits import undefined_values
from verify.functions import in_rings
from verify.late import sympy

_LONG = 100  # terms of an argument, from which on it is not factored
_MOST_FACTORED = 300  # terms, beyond which factoring and sympy take seconds


def as_expression(ring: DifferentialRing, x: Poly) -> sympy.Expr:
    """Convert x to an expression, with its terms as they stand in the ring."""
    return _sum_of_terms(x, _expressions_of_generators(ring, x))


def as_expression_at_0(ring: DifferentialRing, x: Poly, symbol: sympy.Symbol) -> sympy.Expr:
    """Convert x to an expression at symbol = 0; nan where it is undefined there."""
    try:
        generators = {k: g.subs(symbol, 0) for k, g in _expressions_of_generators(ring, x).items()}
        if any(g.has(*undefined_values()) for g in generators.values()):
            return as_expression(ring, x).subs(symbol, 0)
    except TypeError:  # sympy has compared a nan within with a number
        return sympy.nan
    return _sum_of_terms(x, generators)


def _expressions_of_generators(ring: DifferentialRing, x: Poly) -> dict[int, sympy.Expr]:
    """Return the expressions of the generators in x, by their places."""
    generators = {g.index: g for g in ring.generators}
    return {k: _generator_expression(ring, generators[k]) for k in places_in(x)}


def _sum_of_terms(x: Poly, generators: Mapping[int, sympy.Expr]) -> sympy.Expr:
    terms = []
    for monomial, coefficient in terms_of(x):
        factors = [(generators[k], int(n)) for k, n in enumerate(monomial) if n]
        if all(g is not sympy.S.Zero for g, _ in factors):
            terms.append(sympy.Mul(rational_of(coefficient), *(g**n for g, n in factors)))
    return sympy.Add(*terms)


def _generator_expression(ring: DifferentialRing, g: Generator) -> sympy.Expr:
    """Convert the generator to an expression, cached in the ring."""
    if g.index not in ring.expressions:
        ring.expressions[g.index] = generator_expression(g, _argument(ring, g))
    return ring.expressions[g.index]


def _argument(ring: DifferentialRing, g: Generator) -> sympy.Expr:
    """Return the generator's argument as an expression; 0 where it has none."""
    if g.argument is None:
        return sympy.S.Zero
    function = in_rings().get(g.kind)
    # Factored, the argument is mostly the product that was written; of a pair it is a sum.
    factored = function is not None and function.pair is None and len(g.inner) < _LONG
    return (as_product if factored else as_expression)(ring, g.inner)


def as_product(ring: DifferentialRing, x: Poly) -> sympy.Expr:
    """Convert x to an expression, factored into irreducible polynomials in the generators."""
    if x.is_zero():
        return sympy.Integer(0)
    content, factors = x.factor()
    parts = [as_expression(ring, f) ** int(n) for f, n in factors]
    return sympy.Mul(rational_of(content), *parts)


def as_text(ring: DifferentialRing, x: Poly) -> str:
    """Format x as a formula: factored where it has few terms, else as it stands in the ring."""
    if len(x) <= _MOST_FACTORED:
        return to_text(as_product(ring, x))
    names = {
        f"_{g.index}": f"({to_text(_generator_expression(ring, g))})" for g in ring.generators_in(x)
    }
    return re.sub(r"\b_\d+\b", lambda name: names[name[0]], str(x)).replace("^", "**")
