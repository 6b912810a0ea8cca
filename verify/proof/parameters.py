"""For which values of the parameters a coefficient is not the zero function of p and q, and of t
where H depends on time.

That it is not zero at some point says nothing of a single value of δ: 12 δ p q is zero at δ = 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import islice, product
from typing import TypeAlias

from verify.algebra.domain import Domain
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.identities.polynomials import by_monomials
from verify.algebra.requirement import Requirement
from verify.algebra.ring import Poly, Ring
from verify.algebra.zero_test import clear_inverses
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE, coordinates_of
from verify.late import sympy

_STEP_AND_TIME = ("h", "t")
_AT = (0, 1, 2)  # where functions of p and q have simple values
_MOST_POINTS, _FEWEST_POINTS = 81, 9
_LONG = 300  # terms of what is looked at at few points
_MOST_PARTS = 12  # coefficients that are said not to vanish all together


def not_zero_for(ring: Ring, x: Poly, what: str) -> Domain:
    """Where x, which is not the zero function, is not that of p and q for fixed parameters.

    `what` names x where nothing more is known than that it is so for almost all parameters.
    """
    parameters = [name for name in ring.variables if name not in _coordinates(ring)]
    if not any(ring.depends(x, name) for name in parameters):
        return Domain()
    x = clear_inverses(ring, x)  # a denominator is not 0 where x is defined
    inner = _depending(ring, x)
    parts = list(map(ring.context.from_dict, by_monomials(x, inner).values()))
    common = reduce(lambda a, b: a.gcd(b), parts)
    factors = [factor for factor, _ in common.factor()[1]]
    needed = [Requirement(ring.expression(f), "!=") for f in factors]
    if all(index in ring.places.values() for index in inner):  # a polynomial in p and q
        rests = _without_multiples([_radical(part / common, factors) for part in parts])
        if len(rests) <= _MOST_PARTS:
            return Domain.of([*needed, *_not_all_zero([ring.expression(r) for r in rests])])
    written = ring.expression(x)
    if any(_is_product(ring, written, factors, point) for point in _points(ring, x, factors)):
        return Domain.of(needed)
    on = [name for name in parameters if ring.depends(x, name)] or parameters
    return Domain.of(needed, almost_all(on, what, "t" in ring.variables))


def almost_all(parameters: Sequence[str], what: str, timed: bool) -> str:
    """The condition that no value of the parameters is one of the few at which what is named is
    the zero function, where nothing more is known of these."""
    names = parameters[0] if len(parameters) == 1 else f"({', '.join(parameters)})"
    everywhere = "at every point and time" if timed else "at every point"
    return f"{names} is outside of a set of measure 0, not found, on which {what} is 0 {everywhere}"


def _coordinates(ring: Ring) -> tuple[str, ...]:
    return (*coordinates_of(ring.variables), *_STEP_AND_TIME)


def _depending(ring: Ring, x: Poly) -> list[int]:
    """The places of what depends on p or q and is in x."""
    degrees, found, of_state = x.degrees(), list[int](), _coordinates(ring)
    for g in ring.generators_in(x):
        inside = ring.variable(g.name) if g.kind == "variable" else g.argument
        depends = inside is not None and any(ring.depends(inside, n) for n in of_state)
        if depends and degrees[g.index] > 0:
            found.append(g.index)
    return found


# -- of a polynomial in p and q -------------------------------------------------------------------


def _radical(x: Poly, factors: Sequence[Poly]) -> Poly:
    """The product of x's irreducible factors but for those that are known not to vanish."""
    found = [factor for factor, _ in x.factor()[1] if factor not in factors]
    return reduce(lambda a, b: a * b, found, x.context().constant(1))


def _without_multiples(parts: Sequence[Poly]) -> list[Poly]:
    """Those that no other one divides: all vanish where these do."""
    kept: list[Poly] = []
    for part in sorted(parts, key=lambda x: x.total_degree()):
        if all(divmod(part, other)[1] for other in kept):
            kept.append(part)
    return kept


def _not_all_zero(rests: Sequence[sympy.Expr]) -> list[Requirement]:
    """That they do not vanish together, as a sum of squares."""
    together = rests[0] if len(rests) == 1 else sympy.Add(*(rest**2 for rest in rests))
    return [Requirement(together, "!=")]


# -- of functions ---------------------------------------------------------------------------------

_Point: TypeAlias = "tuple[sympy.Expr, ...]"


def _points(ring: Ring, x: Poly, factors: Sequence[Poly]) -> Iterator[_Point]:
    """Values of p and q, and such as make the argument of a function 1: q = 1/a for sin(a q)."""
    simple, names = [sympy.Integer(n) for n in _AT], coordinates_of(ring.variables)
    most = _MOST_POINTS if len(x) < _LONG else _FEWEST_POINTS
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
                at = 1 / ring.expression(slope)
                yield from ((at, n) if name == "p" else (n, at) for n in simple)


def _is_product(ring: Ring, x: sympy.Expr, factors: Sequence[Poly], point: _Point) -> bool:
    """Whether at the point nothing of x is left but some of the factors, and a number not 0."""
    state = (*coordinates_of(ring.variables), "t")
    put = dict(zip(map(symbol, state), (*point, sympy.S.One), strict=True))
    value = x.xreplace(put)
    names = [name for name in ring.variables if name not in state]
    try:
        own, (left, *known) = embed([value, *map(ring.expression, factors)], names)
    except InputError:
        return False
    left = clear_inverses(own, left)
    for factor in known:
        while left and not divmod(left, factor)[1]:
            left = divmod(left, factor)[0]
    free = not any(own.depends(left, name) for name in names)
    return free and own.decide(left).zero is False
