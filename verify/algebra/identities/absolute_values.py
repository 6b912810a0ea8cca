"""The replacement of |v|, to which sympy simplifies √(v²), by ±v where v has one sign."""

from dataclasses import dataclass

import flint
import sympy

from verify.algebra.expressions.functions_used import function_of
from verify.algebra.identities.signs import definite_sign

_MOST_OPERATIONS = 200
_MOST_DEGREE = 40


@dataclass(frozen=True)
class _Generators:
    """The signs and bounds of the generators of a polynomial of sympy's."""

    generators: tuple[sympy.Expr, ...]

    def is_positive(self, place: int) -> bool:
        return bool(self.generators[place].is_positive)

    def is_bounded(self, place: int) -> bool:
        function = function_of(self.generators[place])
        return function is not None and function.bounded


def without_absolute_values(expression: sympy.Expr) -> sympy.Expr:
    """Replace |v| in the expression where the sign of v is shown."""
    return expression.replace(sympy.Abs, _size)


def _size(v: sympy.Expr) -> sympy.Expr:
    sign = sign_of(v)
    return sign * v if sign else sympy.Abs(v)


def sign_of(v: sympy.Expr, *, strict: bool = False) -> int | None:
    """Return 1 if v ≥ 0 everywhere, −1 if v ≤ 0, None where neither is shown.

    `strict`: that v vanishes nowhere is shown, too.
    """
    # sympy's conversion to a polynomial takes long for large v; the sign is then left undecided.
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
    return definite_sign(context.from_dict(terms), _Generators(polynomial.gens), strict=strict)
