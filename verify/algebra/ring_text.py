"""Ring elements as expressions and as text."""

from __future__ import annotations

import re
from collections.abc import Mapping

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.generator import Generator, Poly, generator_expression, rational_of, terms_of
from verify.algebra.identities.polynomials import occurring
from verify.algebra.limits import no_numbers
from verify.functions import in_rings
from verify.late import sympy

_LONG = 100  # terms of what is not factored for that
_MOST_FACTORED = 300  # terms, beyond which factoring and sympy take seconds


def as_expression(ring: DifferentialRing, x: Poly) -> sympy.Expr:
    """x as an expression, its terms as they stand in the ring."""
    return _with(x, _occurring(ring, x))


def as_expression_at_0(ring: DifferentialRing, x: Poly, symbol: sympy.Symbol) -> sympy.Expr:
    """The same where the symbol is 0; nan where it is no expression there."""
    try:
        generators = {k: g.subs(symbol, 0) for k, g in _occurring(ring, x).items()}
        if any(g.has(*no_numbers()) for g in generators.values()):
            return as_expression(ring, x).subs(symbol, 0)
    except TypeError:  # sympy has compared a nan within with a number
        return sympy.nan
    return _with(x, generators)


def _occurring(ring: DifferentialRing, x: Poly) -> dict[int, sympy.Expr]:
    """The generators that stand in x, by their places."""
    generators = {g.index: g for g in ring.generators}
    return {k: _of(ring, generators[k]) for k in occurring(x)}


def _with(x: Poly, generators: Mapping[int, sympy.Expr]) -> sympy.Expr:
    terms = []
    for monomial, coefficient in terms_of(x):
        factors = [(generators[k], int(n)) for k, n in enumerate(monomial) if n]
        if all(g is not sympy.S.Zero for g, _ in factors):
            terms.append(sympy.Mul(rational_of(coefficient), *(g**n for g, n in factors)))
    return sympy.Add(*terms)


def _of(ring: DifferentialRing, g: Generator) -> sympy.Expr:
    """The generator as an expression, made once for each ring."""
    if g.index not in ring.expressions:
        ring.expressions[g.index] = generator_expression(g, _argument(ring, g))
    return ring.expressions[g.index]


def _argument(ring: DifferentialRing, g: Generator) -> sympy.Expr:
    """What it is a function of; 0 where it is of nothing."""
    if g.argument is None:
        return sympy.S.Zero
    function = in_rings().get(g.kind)
    # Of a product, which it mostly was, it is the shorter text; of a pair's argument it is a sum.
    factored = function is not None and function.pair is None and len(g.inner) < _LONG
    return (as_product if factored else as_expression)(ring, g.inner)


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
