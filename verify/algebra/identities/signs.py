"""The sign of a polynomial that has one wherever it is defined, shown by its terms or its roots.

The sign is shown for

- a sum of terms of one sign, each a product of even powers and of positive generators;
- a sum of even powers of one generator whose coefficients have one sign;
- a polynomial in one generator without a (positive) root;
- a quadratic a x² + b x + c if the signs of a and of 4ac − b² are shown;
- a number that exceeds the sum of |coefficients| of the terms in sines and cosines added to it.

None is returned if there is no sign, or it is too hard to show. sympy simplifies √(v²) to |v|; by
the sign of v it is replaced by ±v in an expression.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import flint

from verify.algebra.expressions.function_nodes import function_of
from verify.algebra.identities.polynomials import Poly, split, terms_of
from verify.lazy_sympy import sympy

_MAX_LEVELS = 3
_MAX_TERMS = 60
_MAX_DEGREE = 40
_MAX_BITS = 2000
_MAX_OPERATIONS = 200  # in an expression of sympy


class Facts(Protocol):
    """Facts about generators, all of which are real: signs and bounds."""

    def is_positive(self, place: int) -> bool:
        """Return True if the generator of that place is > 0 wherever it is defined."""
        ...

    def is_bounded(self, place: int) -> bool:
        """Return True if the generator of that place is between −1 and 1."""
        ...


def definite_sign(x: Poly, facts: Facts, *, strict: bool = False) -> int | None:
    """Return 1 if x ≥ 0 everywhere, −1 if x ≤ 0 everywhere, None if neither is shown.

    `strict`: 1 if x > 0, −1 if x < 0.
    """
    if x.is_zero() or len(x) > _MAX_TERMS:
        return None
    if strict and _vanishes_at_origin(x, facts):
        return None
    return _definite_sign(x, facts, strict, _MAX_LEVELS)


def _vanishes_at_origin(x: Poly, facts: Facts) -> bool:
    """Return True if x is 0 if all generators are 0, and no generator in x is positive.

    Then no criterion below can show that x vanishes nowhere: they treat generators as free
    variables. The search would take long: for a squared distance in space 5000 polynomials.
    """
    degrees = x.degrees()
    return x[(0,) * len(degrees)] == 0 and not any(
        power and facts.is_positive(place) for place, power in enumerate(degrees)
    )


def _definite_sign(x: Poly, facts: Facts, strict: bool, levels: int) -> int | None:
    if x.is_zero():
        return None
    by_terms = _sign_by_terms(x, facts, strict)
    if by_terms is not None or levels < 0:
        return by_terms
    common = x.term_content()
    if not common.is_constant():
        # The common power product is a polynomial of one term.
        sign = _sign_by_terms(common, facts, strict)
        cofactor_sign = sign and _definite_sign(x / common, facts, strict, levels - 1)
        return sign * cofactor_sign if sign and cofactor_sign else None
    degrees = x.degrees()
    places = [place for place, power in enumerate(degrees) if power > 0]
    if len(places) == 1:
        return _sign_by_roots(x, places[0], degrees[places[0]], facts)
    for place in places:
        answer = _sign_by_even_powers(x, place, facts, strict, levels - 1)
        if answer is None and degrees[place] == 2:
            answer = _sign_by_square(x, place, facts, strict, levels - 1)
        if answer is not None:
            return answer
    return None


def _sign_by_terms(x: Poly, facts: Facts, strict: bool) -> int | None:
    """Return the sign if all terms have one sign, except terms in bounded generators (sines and
    cosines), whose |coefficients| together must not exceed the constant term."""
    number = x[(0,) * len(x.degrees())]
    sign, slack, nowhere_zero = (number > 0) - (number < 0), abs(number), False
    for monomial, c in terms_of(x):
        places = [place for place, power in enumerate(monomial) if power]
        signed = all(monomial[place] % 2 == 0 or facts.is_positive(place) for place in places)
        if signed and sign * c >= 0:
            sign = 1 if c > 0 else -1
            nowhere_zero |= all(facts.is_positive(place) for place in places)
        elif number != 0 and all(facts.is_bounded(place) for place in places):
            slack -= abs(c)
        else:
            return None
    if number != 0 and slack < 0:
        return None
    return sign if not strict or (nowhere_zero and (number == 0 or slack > 0)) else None


def _sign_by_roots(x: Poly, place: int, degree: int, facts: Facts) -> int | None:
    """Return the sign of a polynomial in one generator that has no root (for a positive generator,
    no positive root)."""
    coefficients = [flint.fmpq(0)] * (degree + 1)
    for monomial, c in terms_of(x):
        coefficients[monomial[place]] = c
    polynomial = flint.fmpq_poly(coefficients).numer()
    if degree > _MAX_DEGREE or polynomial.height_bits() > _MAX_BITS:
        return None
    roots: Any = polynomial.complex_roots()  # the imaginary part of a real root is exactly 0
    real = [root for root, _ in roots if root.imag == 0]
    # A negative root does no harm if the generator is positive.
    if any(not (facts.is_positive(place) and root.real < 0) for root in real):
        return None
    return 1 if x.leading_coefficient() > 0 else -1


def _sign_by_even_powers(
    x: Poly, place: int, facts: Facts, strict: bool, levels: int
) -> int | None:
    """Return the sign of a sum of even powers of a generator, or any powers of a positive one."""
    signs = set()
    for power, part in split(x, place).items():
        if power % 2 and not facts.is_positive(place):
            return None
        signs.add(_definite_sign(part, facts, strict and power == 0, levels))
    return signs.pop() if len(signs) == 1 else None


def _sign_by_square(x: Poly, place: int, facts: Facts, strict: bool, levels: int) -> int | None:
    parts = split(x, place)
    c, b, a = (parts.get(power, x * 0) for power in range(3))
    sign = _definite_sign(a, facts, True, levels)
    # a x² + b x + c = ((2 a x + b)² + 4 a c − b²)/(4 a) has the sign of a if 4 a c − b² ≥ 0.
    if sign is None or _definite_sign(4 * a * c - b * b, facts, strict, levels) != 1:
        return None
    return sign


# -- expressions of sympy -------------------------------------------------------------------------


@dataclass(frozen=True)
class _SympyGenerators:
    """Facts about the generators of a polynomial of sympy."""

    generators: tuple[sympy.Expr, ...]

    def is_positive(self, place: int) -> bool:
        return bool(self.generators[place].is_positive)

    def is_bounded(self, place: int) -> bool:
        function = function_of(self.generators[place])
        return function is not None and function.bounded


def without_absolute_values(expression: sympy.Expr) -> sympy.Expr:
    """Return the expression with ±v for every |v| if the sign of v is shown."""
    return expression.replace(sympy.Abs, _without_sign)


def _without_sign(v: sympy.Expr) -> sympy.Expr:
    sign = sign_of(v)
    return sign * v if sign else sympy.Abs(v)


def sign_of(v: sympy.Expr, *, strict: bool = False) -> int | None:
    """Return 1 if v ≥ 0 everywhere, −1 if v ≤ 0 everywhere, None if neither is shown.

    `strict`: 1 if v > 0, −1 if v < 0.
    """
    # sympy's conversion to a polynomial takes long for large v; the sign is then left undecided.
    if v.count_ops() > _MAX_OPERATIONS:
        return None
    try:
        polynomial = sympy.Poly(v, domain=sympy.QQ)
    except sympy.PolynomialError:
        return None
    if polynomial.total_degree() > _MAX_DEGREE:
        return None
    names = [f"_{k}" for k in range(len(polynomial.gens))]
    context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex)
    terms = {m: flint.fmpq(int(c.p), int(c.q)) for m, c in polynomial.terms()}
    return definite_sign(context.from_dict(terms), _SympyGenerators(polynomial.gens), strict=strict)
