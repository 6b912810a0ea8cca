"""A scheme's coefficients as a certificate has them: `stages` or a `tableau`, and `numbers`.

Coefficients are embedded in one ring together. Each of its generators is a real algebraic number,
and gets a name, its minimal polynomial, such as b wⁿ − a, and an interval in which the checker
finds one root.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import flint
import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.generator import Generator, Poly, terms_of
from verify.algebra.ring import Ring
from verify.arithmetic.arb import Ball, bounds, in_reach
from verify.errors import InputError
from verify.proof.certificates.minimal_polynomial import MinimalPolynomials
from verify.proof.certificates.numbers import MOST_DEGREE, Number, check_root
from verify.proof.certificates.readers import Monomial
from verify.schemes.conditions.every_hamiltonian import StageEquations
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.timed.for_scheme import conditions_for
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.scheme import Scheme

_PRECISION = 512
_HALVED = 300  # times an interval is, until it has one root
Rows = list[list[Any]]  # of sympy's numbers, or of what stands for them in the file


def by_coefficients(scheme: Scheme, *, timed: bool) -> dict[str, Any] | None:
    """What is to stand in the certificate; None of a scheme that is not given by such.

    Raises InputError for a coefficient that is not made by roots, or of too high a degree.
    """
    every_h = scheme.every_h
    rows = _rows(every_h)
    if rows is None:
        return None
    if timed:
        rows.append(list(conditions_for(every_h).clock))
    written, numbers = _written(scheme.name, rows)
    clock = written.pop() if timed else []
    if isinstance(every_h, TreeConditions):
        *a, b = written
        found: dict[str, Any] = {"tableau": {"a": a, "b": b, **({"c": clock} if timed else {})}}
    elif timed:
        found = {"stages": [[*row, time] for row, time in zip(written, clock, strict=True)]}
    else:
        found = {"stages": written}
    return {"numbers": numbers, **found} if numbers else found


def _rows(every_h: object) -> Rows | None:
    """Those of the stages, or of the tableau with its weights."""
    none = sympy.S.Zero
    if isinstance(every_h, Splitting):
        each = {"kick": lambda x: [x, none, none, none], "drift": lambda x: [none, x, none, none]}
        return [each[kind](size) for kind, size in every_h.parts]
    if isinstance(every_h, StageEquations):
        stages = ((s.kick, s.drift, s.at_p, s.at_q) for s in every_h.stages)
        return [[sympy.Rational(x.numerator, x.denominator) for x in row] for row in stages]
    if isinstance(every_h, TreeConditions):
        return [list(row) for row in (*every_h.tableau.rows, every_h.tableau.weights)]
    return None


def _written(scheme: str, rows: Rows) -> tuple[Rows, list[list[Any]]]:
    """The rows as texts, and as terms in names where they are irrational, and what these are."""
    ring, elements = embed([x for row in rows for x in row], ())
    own = _own(ring, elements)
    names = {g.index: "w" if len(own) == 1 else f"w{k}" for k, g in enumerate(own, 1)}
    texts = iter([_coefficient(x, names) for x in elements])
    minimal = MinimalPolynomials(ring, MOST_DEGREE)
    numbers = [_number(scheme, minimal, g, names[g.index]) for g in own]
    return [[next(texts) for _ in row] for row in rows], numbers


def _own(ring: Ring, elements: list[Poly]) -> list[Generator]:
    """The generators that stand in the elements, arguments left out."""
    found = {k for x in elements for m, _ in terms_of(x) for k, n in enumerate(m) if n}
    return [g for g in ring.generators if g.index in found]


def _coefficient(x: Poly, names: Mapping[int, str]) -> str | list[list[str]]:
    if x.is_zero():
        return "0"
    found = terms(x, names)
    return found[0][0] if x.is_constant() else found


def terms(x: Poly, names: Mapping[int, str]) -> list[list[str]]:
    """The polynomial as a list of terms; `names`: of the variables by their index."""
    return [
        [str(c), *(names[k] for k, n in enumerate(monomial) for _ in range(int(n)))]
        for monomial, c in terms_of(x)
    ]


def polynomial(
    context: flint.fmpq_mpoly_ctx, places: Mapping[str, int], x: Mapping[Monomial, Fraction]
) -> Poly:
    """The checker's polynomial in a ring; `places`: those of the variables by their names."""
    found = {}
    for names, c in x.items():
        powers = [0] * context.nvars()
        for name in names:
            powers[places[name]] += 1
        found[tuple(powers)] = flint.fmpq(c.numerator, c.denominator)
    return context.from_dict(found)


# -- numbers --------------------------------------------------------------------------------------


def _number(scheme: str, minimal: MinimalPolynomials, g: Generator, name: str) -> list[Any]:
    """The entry of `numbers` that is this generator."""
    element = minimal.ring.context.gens()[g.index]
    try:
        polynomial = tuple(int(c) for c in minimal.of(g.index).coeffs())
        number = _isolated(name, polynomial, enclose(minimal.ring, element, {}, _PRECISION))
    except ValueError as problem:
        shown = str(minimal.ring.expression(element))[:60]
        raise InputError("scheme", scheme, f"{shown} {problem}: no certificate") from None
    return [name, [*map(str, polynomial)], str(number.low), str(number.high)]


def _isolated(name: str, polynomial: tuple[int, ...], ball: Ball | None) -> Number:
    """The number in the largest interval that is seen to have no other root."""
    if ball is not None and in_reach(ball):
        least, most = bounds(ball)
        for k in range(_HALVED):
            low = Fraction(math.floor(least * 2**k), 2**k)
            number = Number(name, polynomial, low, low + Fraction(1, 2**k))
            if most <= number.high and _has_one_root(number):
                return number
    raise ValueError("is in no interval that is found")


def _has_one_root(number: Number) -> bool:
    try:
        check_root(number)
    except ValueError:
        return False
    return True
