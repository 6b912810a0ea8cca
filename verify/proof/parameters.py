"""The parameter values for which a coefficient is not the zero function of p and q (and t).

A witness proves this only for its own values of the parameters: 12 δ p q is not zero at δ = 1, and
is the zero function for δ = 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import islice, product
from typing import TypeAlias

from verify.algebra.domain import FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.expressions.function_nodes import Requirement
from verify.algebra.formula import symbol
from verify.algebra.identities.polynomials import split_by_monomials
from verify.algebra.ring import Poly, Ring
from verify.algebra.zero_test import clear_inverses
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE, coordinates_of
from verify.lazy_sympy import sympy

_Point: TypeAlias = "tuple[sympy.Expr, ...]"
_STEP_AND_TIME = ("h", "t")
_SIMPLE_COORDINATES = (0, 1, 2)  # functions of p and q have simple values at them
_MOST_POINTS, _FEWEST_POINTS = 81, 9  # limits of the points tried for short and long elements
_MANY_TERMS = 300  # terms; an element of as many or more is long
_MOST_PARTS = 12  # limit of the coefficients in the condition that not all of them vanish


def not_zero_for(ring: Ring, x: Poly, what: str) -> FormulaDomain:
    """Return the parameters for which x, as a function of p and q alone, is not zero.

    x must not be the zero function of coordinates and parameters. `what` names x in the sentence
    that is returned if the exceptional parameters are not determined, but only have measure 0.
    """
    parameters = [name for name in ring.variables if name not in _coordinates(ring)]
    if not any(ring.depends(x, name) for name in parameters):
        return FormulaDomain()
    x = clear_inverses(ring, x)  # a denominator is not 0 where x is defined
    inner = _state_dependent(ring, x)
    # As a polynomial in the parts that depend on p and q, x is zero if all its coefficients vanish:
    # their common factors must not be 0, and the remaining factors must not vanish together.
    parts = list(map(ring.context.from_dict, split_by_monomials(x, inner).values()))
    common = reduce(lambda a, b: a.gcd(b), parts)
    factors = [factor for factor, _ in common.factor()[1]]
    requirements = [Requirement(ring.expression(f), "!=") for f in factors]
    if all(index in ring.places.values() for index in inner):  # a polynomial in p and q
        rests = _without_multiples([_radical(part / common, factors) for part in parts])
        if len(rests) <= _MOST_PARTS:
            return FormulaDomain.from_requirements(
                [*requirements, *_not_all_zero([ring.expression(r) for r in rests])]
            )
    # If x at some point is a product of the common factors, these are the only condition.
    if any(_is_product_at(ring, x, factors, point) for point in _points(ring, x, factors)):
        return FormulaDomain.from_requirements(requirements)
    names = [name for name in parameters if ring.depends(x, name)] or parameters
    return FormulaDomain.from_requirements(
        requirements, almost_all(names, what, "t" in ring.variables)
    )


def almost_all(parameters: Sequence[str], what: str, timed: bool) -> str:
    """Format the condition that the parameters are outside the set on which `what` is zero.

    It is used if that set is shown to have measure 0, and is not known otherwise.
    """
    names = parameters[0] if len(parameters) == 1 else f"({', '.join(parameters)})"
    everywhere = "at every point and time" if timed else "at every point"
    return f"{names} is outside of a set of measure 0, not found, on which {what} is 0 {everywhere}"


def _state(ring: Ring) -> tuple[str, ...]:
    """Return the coordinates, which stand before h among the variables."""
    names = ring.variables
    return names[: names.index("h")] if "h" in names else coordinates_of(names)


def _coordinates(ring: Ring) -> tuple[str, ...]:
    return (*_state(ring), *_STEP_AND_TIME)


def _state_dependent(ring: Ring, x: Poly) -> list[int]:
    """Return the indices of the variables and generators in x that depend on p, q, h or t."""
    degrees, places, state = x.degrees(), list[int](), _coordinates(ring)
    for g in ring.generators_in(x):
        inside = ring.variable(g.name) if g.kind == "variable" else g.argument
        depends = inside is not None and any(ring.depends(inside, n) for n in state)
        if depends and degrees[g.index] > 0:
            places.append(g.index)
    return places


# -- polynomials in p and q -----------------------------------------------------------------------


def _radical(x: Poly, factors: Sequence[Poly]) -> Poly:
    """Return the product of x's irreducible factors without those in `factors`."""
    remaining = [factor for factor, _ in x.factor()[1] if factor not in factors]
    return reduce(lambda a, b: a * b, remaining, x.context().constant(1))


def _without_multiples(parts: Sequence[Poly]) -> list[Poly]:
    """Drop the parts that another one divides: they vanish wherever it does."""
    minimal: list[Poly] = []
    for part in sorted(parts, key=lambda x: x.total_degree()):
        if all(divmod(part, divisor)[1] for divisor in minimal):
            minimal.append(part)
    return minimal


def _not_all_zero(parts: Sequence[sympy.Expr]) -> list[Requirement]:
    """Return the requirement that not all parts are 0: the sum of their squares is not 0."""
    together = parts[0] if len(parts) == 1 else sympy.Add(*(part**2 for part in parts))
    return [Requirement(together, "!=")]


# -- functions ------------------------------------------------------------------------------------


def _points(ring: Ring, x: Poly, factors: Sequence[Poly]) -> Iterator[_Point]:
    """Yield points; some make the argument of a function 1, such as q = 1/a for sin(a q)."""
    simple, names = [sympy.Integer(n) for n in _SIMPLE_COORDINATES], _state(ring)
    most = _MOST_POINTS if len(x) < _MANY_TERMS else _FEWEST_POINTS
    yield from islice(product(simple, repeat=len(names)), most)
    for g in ring.generators_in(x) if names == PLANE else ():
        for name in PLANE:
            if g.kind == "variable" or g.argument is None:
                continue
            slope = ring.diff(g.argument, name)
            if slope.is_zero() or any(ring.depends(slope, n) for n in _coordinates(ring)):
                continue
            cleared = clear_inverses(ring, slope)
            if all(f in factors for f, _ in cleared.factor()[1]):
                value = 1 / ring.expression(slope)
                yield from ((value, n) if name == "p" else (n, value) for n in simple)


def _is_product_at(ring: Ring, x: Poly, factors: Sequence[Poly], point: _Point) -> bool:
    """Return True if x at the point is a product of some of the factors and a nonzero number."""
    state = (*_state(ring), "t")
    values = dict(zip(map(symbol, state), (*point, sympy.S.One), strict=True))
    value = ring.expression_at(x, values)
    names = [name for name in ring.variables if name not in state]
    try:
        constants, (remaining, *divisors) = embed([value, *map(ring.expression, factors)], names)
    except InputError:
        return False
    remaining = clear_inverses(constants, remaining)
    for factor in divisors:
        # Each factor may occur several times in the product.
        while remaining and not divmod(remaining, factor)[1]:
            remaining = divmod(remaining, factor)[0]
    free = not any(constants.depends(remaining, name) for name in names)
    return free and constants.decide(remaining).zero is False
