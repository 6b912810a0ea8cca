"""|v| as v or −v, where sympy has made √(v²) an absolute value and v has one sign everywhere."""

from dataclasses import dataclass

import flint
import sympy

from verify.algebra.expressions.functions_used import function_of
from verify.algebra.identities.signs import definite

_MOST_OPERATIONS = 200
_MOST_DEGREE = 40


@dataclass(frozen=True)
class _Generators:
    """What is known of those of a polynomial of sympy's."""

    generators: tuple[sympy.Expr, ...]

    def positive(self, place: int) -> bool:
        return bool(self.generators[place].is_positive)

    def bounded(self, place: int) -> bool:
        function = function_of(self.generators[place])
        return function is not None and function.bounded


def without_absolute_values(expression: sympy.Expr) -> sympy.Expr:
    """The expression, with |v| replaced where the sign of v is shown."""
    return expression.replace(sympy.Abs, _size)


def _size(v: sympy.Expr) -> sympy.Expr:
    sign = sign_of(v)
    return sign * v if sign else sympy.Abs(v)


def sign_of(v: sympy.Expr, *, strict: bool = False) -> int | None:
    """1 where v ≥ 0 everywhere, −1 where v ≤ 0, None where neither is shown.

    `strict`: that v vanishes nowhere is shown, too.
    """
    if v.count_ops() > _MOST_OPERATIONS:
        return None
    try:
        polynomial = sympy.Poly(v, domain=sympy.QQ)
    except sympy.PolynomialError:
        return None
    if polynomial.total_degree() > _MOST_DEGREE:
        return None
    names = [f"_{k}" for k in range(len(polynomial.gens))]
    context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex)
    terms = {m: flint.fmpq(int(c.p), int(c.q)) for m, c in polynomial.terms()}
    return definite(context.from_dict(terms), _Generators(polynomial.gens), strict=strict)
