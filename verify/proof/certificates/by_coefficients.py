"""The coefficients of a scheme in a certificate: `stages` or a `tableau`, and `numbers`.

All coefficients are embedded in one ring. Each of its generators is a real algebraic number, and
gets a name, its minimal polynomial, such as b wⁿ − a, and an interval in which the checker finds
one root.
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
from verify.arithmetic.arb import Ball, bounds, is_representable
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
_HALVED = 300  # halvings of an interval, at most, until it has one root
Rows = list[list[Any]]  # of sympy's numbers, or of what stands for them in the file


def write_coefficients(scheme: Scheme, *, timed: bool) -> dict[str, Any] | None:
    """Return the certificate's entries for the coefficients; None for a scheme without such.

    Raises InputError for a coefficient that is not expressed by roots, or of too high a degree.
    """
    every_h = scheme.every_h
    rows = _rows(every_h)
    if rows is None:
        return None
    # The clock is one more row while the numbers are embedded, so all share one set of generators.
    if timed:
        rows.append(list(conditions_for(every_h).clock))
    texts, numbers = _write_rows(scheme.name, rows)
    clock = texts.pop() if timed else []
    if isinstance(every_h, TreeConditions):
        *a, b = texts
        entries: dict[str, Any] = {"tableau": {"a": a, "b": b, **({"c": clock} if timed else {})}}
    elif timed:
        entries = {"stages": [[*row, time] for row, time in zip(texts, clock, strict=True)]}
    else:
        entries = {"stages": texts}
    return {"numbers": numbers, **entries} if numbers else entries


def _rows(every_h: object) -> Rows | None:
    """Return the rows of the stages, or of the tableau with its weights."""
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


def _write_rows(scheme: str, rows: Rows) -> tuple[Rows, list[list[Any]]]:
    """Return the rows in JSON's form, with terms in names for irrational numbers, and these."""
    ring, elements = embed([x for row in rows for x in row], ())
    generators = _generators_in(ring, elements)
    names = {g.index: "w" if len(generators) == 1 else f"w{k}" for k, g in enumerate(generators, 1)}
    texts = iter([_coefficient(x, names) for x in elements])
    minimal = MinimalPolynomials(ring, MOST_DEGREE)
    numbers = [_number(scheme, minimal, g, names[g.index]) for g in generators]
    return [[next(texts) for _ in row] for row in rows], numbers


def _generators_in(ring: Ring, elements: list[Poly]) -> list[Generator]:
    """Return the generators that occur in the elements, without those in their arguments."""
    indices = {k for x in elements for m, _ in terms_of(x) for k, n in enumerate(m) if n}
    return [g for g in ring.generators if g.index in indices]


def _coefficient(x: Poly, names: Mapping[int, str]) -> str | list[list[str]]:
    if x.is_zero():
        return "0"
    listed = terms(x, names)
    return listed[0][0] if x.is_constant() else listed


def terms(x: Poly, names: Mapping[int, str]) -> list[list[str]]:
    """Return the polynomial as a list of terms; `names`: of the variables by their index."""
    return [
        [str(c), *(names[k] for k, n in enumerate(monomial) for _ in range(int(n)))]
        for monomial, c in terms_of(x)
    ]


def polynomial(
    context: flint.fmpq_mpoly_ctx, places: Mapping[str, int], x: Mapping[Monomial, Fraction]
) -> Poly:
    """Convert the checker's polynomial to a ring; `places`: of the variables by their names."""
    by_powers = {}
    for names, c in x.items():
        powers = [0] * context.nvars()
        for name in names:
            powers[places[name]] += 1
        by_powers[tuple(powers)] = flint.fmpq(c.numerator, c.denominator)
    return context.from_dict(by_powers)


# -- numbers --------------------------------------------------------------------------------------


def _number(scheme: str, minimal: MinimalPolynomials, g: Generator, name: str) -> list[Any]:
    """Return the entry of `numbers` for this generator."""
    element = minimal.ring.context.gens()[g.index]
    try:
        polynomial = tuple(int(c) for c in minimal.polynomial_of(g.index).coeffs())
        number = _isolate(name, polynomial, enclose(minimal.ring, element, {}, _PRECISION))
    except ValueError as problem:
        expression = str(minimal.ring.expression(element))[:60]
        raise InputError("scheme", scheme, f"{expression} {problem}: no certificate") from None
    return [name, [*map(str, polynomial)], str(number.low), str(number.high)]


def _isolate(name: str, polynomial: tuple[int, ...], ball: Ball | None) -> Number:
    """Isolate the number in the largest dyadic interval that is shown to have no other root."""
    if ball is not None and is_representable(ball):
        least, most = bounds(ball)
        for k in range(_HALVED):
            low = Fraction(math.floor(least * 2**k), 2**k)
            # Halving ends: near the root the derivative has one sign, and the ball is far narrower.
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
