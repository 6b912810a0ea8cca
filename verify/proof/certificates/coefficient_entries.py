"""The coefficients of a scheme in a certificate: `stages` or a `tableau`, and `numbers`.

All coefficients are embedded in one ring. Each of its generators is a real algebraic number, which
gets a name, its minimal polynomial, such as b wⁿ − a, and an interval in which the checker verifies
exactly one root.

The minimal polynomial has integer coefficients. A generator of a ring without variables is the
root, or the inverse, of a number u that is a polynomial in older generators, u = x(g_1, …, g_k).
Let P_j be the minimal polynomial of g_j. The resultant of X − x(x_1, …, x_k) and P_1(x_1), then of
that and P_2(x_2), and so on, vanishes at X = u. With f(u) = 0, f(wⁿ) is 0 for the n-th root w, and
the reversed f for 1/u. The irreducible factor that vanishes at the number is the one whose
enclosures there never exclude 0.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import flint
import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.identities.polynomials import Generator, Poly, places_in, terms_of
from verify.algebra.ring import Ring
from verify.arithmetic.arb import Ball, bounds, is_representable
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.proof.certificates.named_numbers import MOST_DEGREE, AlgebraicNumber, check_root
from verify.proof.certificates.readers import Monomial
from verify.schemes.conditions.every_hamiltonian import StageEquations
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.scheme import Scheme

Rows = list[list[Any]]  # rows of numbers, as sympy has them or as the file does
_ISOLATION_BITS = 512  # the precision of the enclosure from which an interval is derived
_MOST_HALVINGS = 300  # limit of the halvings of an interval until it has one root
_FACTOR_BITS = (256, 1024, 4096)  # precisions that are tried to single out a factor


# -- numbers --------------------------------------------------------------------------------------


class MinimalPolynomials:
    """The minimal polynomials of the generators of one ring, up to a degree of `most`."""

    def __init__(self, ring: Ring, most: int) -> None:
        self.ring, self.most = ring, most
        self._kinds = {g.index: g for g in ring.generators}
        self._cache: dict[int, flint.fmpz_poly] = {}

    def polynomial_of(self, index: int) -> flint.fmpz_poly:
        """Return the minimal polynomial of a generator; ValueError says why there is none."""
        if index not in self._cache:
            self._cache[index] = self._compute(index)
        return self._cache[index]

    def _compute(self, index: int) -> flint.fmpz_poly:
        g = self._kinds[index]
        if g.kind not in ("root", "inverse"):
            raise ValueError("is not made by roots")
        inner = self._of_element(g.inner)
        if g.kind == "inverse":
            # X^n f(1/X) vanishes at 1/u where f vanishes at u.
            polynomial = flint.fmpz_poly(inner.coeffs()[::-1])
        else:
            self._check(inner.degree() * g.degree)
            polynomial = inner.inflate(g.degree)
        return self._factor(polynomial, self.ring.context.gens()[index])

    def _of_element(self, x: Poly) -> flint.fmpz_poly:
        if x.is_constant():
            c = x.leading_coefficient()
            return flint.fmpz_poly([-int(c.p), int(c.q)])
        indices = places_in(x)
        self._check(math.prod(self.polynomial_of(index).degree() for index in indices))
        # X − x, from which each generator is eliminated by a resultant with its polynomial.
        names = ["x", *(f"_{index}" for index in indices)]
        context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex)
        variable, *generators = context.gens()
        resultant = variable - context.from_dict(
            {(0, *(monomial[index] for index in indices)): c for monomial, c in terms_of(x)}
        )
        for name, gen, index in zip(names[1:], generators, indices, strict=True):
            powers = (c * gen**n for n, c in enumerate(self.polynomial_of(index).coeffs()))
            resultant = resultant.resultant(sum(powers, context.constant(0)), name)
        by_power = {powers[0]: c for powers, c in terms_of(resultant)}
        coefficients = [by_power.get(n, 0) for n in range(max(by_power) + 1)]
        return self._factor(flint.fmpq_poly(coefficients).numer(), x)

    def _check(self, degree: int) -> None:
        if degree > self.most:
            raise ValueError(f"is of degree {degree}, or seems so; allowed: up to {self.most}")

    def _factor(self, polynomial: flint.fmpz_poly, x: Poly) -> flint.fmpz_poly:
        """Return the irreducible factor that vanishes at x; ValueError if that is undecided."""
        factors = [factor for factor, _ in polynomial.factor()[1]]
        for precision in _FACTOR_BITS:
            ball = enclose(self.ring, x, {}, precision)
            with working_precision(precision):
                factors = [f for f in factors if ball is None or f(ball).contains(0)]
            if len(factors) == 1:
                return factors[0]
        raise ValueError("is not told from other numbers")


def _number(scheme: str, minimal: MinimalPolynomials, g: Generator, name: str) -> list[Any]:
    """Return the entry of `numbers` for a generator; InputError if there is none."""
    element = minimal.ring.context.gens()[g.index]
    try:
        polynomial = tuple(int(c) for c in minimal.polynomial_of(g.index).coeffs())
        number = _isolate(name, polynomial, enclose(minimal.ring, element, {}, _ISOLATION_BITS))
    except ValueError as problem:
        expression = str(minimal.ring.expression(element))[:60]
        raise InputError("scheme", scheme, f"{expression} {problem}: no certificate") from None
    return [name, [*map(str, polynomial)], str(number.low), str(number.high)]


def _isolate(name: str, polynomial: tuple[int, ...], ball: Ball | None) -> AlgebraicNumber:
    """Isolate the number in the largest dyadic interval that is shown to have no other root."""
    if ball is not None and is_representable(ball):
        least, greatest = bounds(ball)
        for k in range(_MOST_HALVINGS):
            low = Fraction(math.floor(least * 2**k), 2**k)
            # The halving succeeds: near a simple root the derivative has one sign, and the ball is
            # far narrower than the interval.
            number = AlgebraicNumber(name, polynomial, low, low + Fraction(1, 2**k))
            if greatest <= number.high and _has_one_root(number):
                return number
    raise ValueError("is in no interval that is found")


def _has_one_root(number: AlgebraicNumber) -> bool:
    try:
        check_root(number)
    except ValueError:
        return False
    return True


# -- rows of coefficients -------------------------------------------------------------------------


def write_coefficients(scheme: Scheme, *, timed: bool) -> dict[str, Any] | None:
    """Return the certificate's entries for the coefficients; None for a scheme without any.

    Raises InputError for a coefficient that is not expressed by roots, or of too high a degree.
    """
    every_h = scheme.every_h
    rows = _rows(every_h)
    if rows is None:
        return None
    # The clock is embedded as one more row, so that all numbers share one set of generators.
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
    """Return the rows of the stages, or those of the tableau with the weights last."""
    zero = sympy.S.Zero
    if isinstance(every_h, Splitting):
        row_of = {"kick": lambda x: [x, zero, zero, zero], "drift": lambda x: [zero, x, zero, zero]}
        return [row_of[kind](size) for kind, size in every_h.parts]
    if isinstance(every_h, StageEquations):
        stages = ((s.kick, s.drift, s.at_p, s.at_q) for s in every_h.stages)
        return [[sympy.Rational(x.numerator, x.denominator) for x in row] for row in stages]
    if isinstance(every_h, TreeConditions):
        return [list(row) for row in (*every_h.tableau.rows, every_h.tableau.weights)]
    return None


def _write_rows(scheme: str, rows: Rows) -> tuple[Rows, list[list[Any]]]:
    """Return the rows as in JSON, and the entries of `numbers` whose names they use."""
    ring, elements = embed([x for row in rows for x in row], ())
    generators = _generators_in(ring, elements)
    names = {g.index: "w" if len(generators) == 1 else f"w{k}" for k, g in enumerate(generators, 1)}
    texts = iter([_coefficient(x, names) for x in elements])
    minimal = MinimalPolynomials(ring, MOST_DEGREE)
    numbers = [_number(scheme, minimal, g, names[g.index]) for g in generators]
    return [[next(texts) for _ in row] for row in rows], numbers


def _generators_in(ring: Ring, elements: list[Poly]) -> list[Generator]:
    """Return the generators that occur in the elements themselves, not in arguments."""
    indices = {k for x in elements for m, _ in terms_of(x) for k, n in enumerate(m) if n}
    return [g for g in ring.generators if g.index in indices]


def _coefficient(x: Poly, names: Mapping[int, str]) -> str | list[list[str]]:
    if x.is_zero():
        return "0"
    listed = terms(x, names)
    return listed[0][0] if x.is_constant() else listed


def terms(x: Poly, names: Mapping[int, str]) -> list[list[str]]:
    """Return the polynomial as a list of terms; `names[k]` is the name of variable k."""
    return [
        [str(c), *(names[k] for k, n in enumerate(monomial) for _ in range(int(n)))]
        for monomial, c in terms_of(x)
    ]


def polynomial_in(
    context: flint.fmpq_mpoly_ctx, places: Mapping[str, int], x: Mapping[Monomial, Fraction]
) -> Poly:
    """Convert a polynomial of the checker to a ring; `places`: variables' indices by name."""
    by_powers = {}
    for names, c in x.items():
        powers = [0] * context.nvars()
        for name in names:
            powers[places[name]] += 1
        by_powers[tuple(powers)] = flint.fmpq(c.numerator, c.denominator)
    return context.from_dict(by_powers)
