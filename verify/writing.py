"""Ring elements as expressions and as text."""

import re
from typing import TYPE_CHECKING

import sympy

from verify.formula import to_text
from verify.generator import Generator, Poly, rational_of, written

if TYPE_CHECKING:
    from verify.ring import Ring


def as_expression(ring: "Ring", x: Poly, known: dict[int, sympy.Expr]) -> sympy.Expr:
    """x as an expression, its terms as they stand; `known` keeps what its generators became."""
    made = {g.index: g for g in ring.generators}

    def of(g: Generator) -> sympy.Expr:
        if g.expression is not None:
            return g.expression
        if g.index not in known:
            known[g.index] = written(g, as_expression(ring, g.argument, known))
        return known[g.index]

    terms = []
    for monomial, coefficient in x.to_dict().items():
        factors = [of(made[k]) ** int(n) for k, n in enumerate(monomial) if n]
        terms.append(sympy.Mul(rational_of(coefficient), *factors))
    return sympy.Add(*terms)


def as_it_stands(ring: "Ring", x: Poly) -> str:
    """x as a formula, neither factored nor made an expression of."""
    made = {f"g{g.index}_": f"({to_text(g.expression)})" for g in ring.generators}
    return re.sub(r"\bg\d+_", lambda name: made[name[0]], str(x)).replace("^", "**")
