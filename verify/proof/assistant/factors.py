"""Factors that show the residuals of a certificate for one H to be 0: residual = Σ factor·relation.

The relations are those of the theory, one for each function but exp: sin² + cos² = 1 and
u·(1/u) = 1. The residuals are the theory's too (`Identities.v`), in its order. The cofactors in the
certificate are for other residuals, in which X (or D) is applied to a coordinate repeatedly.

A polynomial is written as a sum of multiples of relations by division. If that is not enough, it is
divided by a Gröbner basis (Buchberger's algorithm), each element of which is such a sum itself.
"""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx

from verify.errors import NOT_GIVEN, InputError
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.coefficient_entries import polynomial_in
from verify.proof.certificates.entries import Expansion
from verify.proof.certificates.readers import Poly

_MOST_PAIRS = 2000  # limit of the S-polynomials that are examined
_MOST_TERMS = 20_000  # limit of the terms in the factors of a new element
Sum = dict[int, fmpq_mpoly]  # Σ factor·relation, as factors by the number of the relation
Factors = list[tuple[int, Poly]]  # (number of a relation, its factor)


# -- sums of multiples of relations ---------------------------------------------------------------


class _Element(NamedTuple):
    """A polynomial of the ideal, with the factors that write it as a sum of multiples."""

    poly: fmpq_mpoly
    factors: Sum


class Basis:
    """A basis of the ideal of some relations, polynomials in one ring, each with a number."""

    def __init__(self, ring: fmpq_mpoly_ctx, relations: Iterable[tuple[int, fmpq_mpoly]]) -> None:
        self.ring = ring
        unity = ring.constant(1)
        self.elements = [_Element(x, {number: unity}) for number, x in relations if x]
        self.complete = False

    def find_sum(self, x: fmpq_mpoly) -> Sum | None:
        """Write a polynomial as a sum of multiples of the relations; None if none is found."""
        remainder, factors = self._divide(x)
        if remainder and not self.complete:
            self._complete()
            remainder, factors = self._divide(x)
        return None if remainder else factors

    def _divide(self, x: fmpq_mpoly) -> tuple[fmpq_mpoly, Sum]:
        factors: Sum = {}
        has_changed = True
        # Division by one element may make terms divisible by an earlier one: the loop repeats.
        while has_changed and x:
            has_changed = False
            for element in self.elements:
                quotient, x = divmod(x, element.poly)
                if quotient:
                    has_changed = True
                    self._add(factors, quotient, element.factors)
        return x, factors

    def _complete(self) -> None:
        """Complete the elements to a Gröbner basis by Buchberger's algorithm, within limits."""
        self.complete = True
        pairs = list(combinations(range(len(self.elements)), 2))
        for _ in range(_MOST_PAIRS):
            if not pairs:
                return
            i, j = pairs.pop(0)
            difference = self._s_polynomial(self.elements[i], self.elements[j])
            if difference is None:
                continue
            remainder, factors = self._divide(difference.poly)
            if remainder:
                self._add(difference.factors, self.ring.constant(-1), factors)
                if sum(map(len, difference.factors.values())) > _MOST_TERMS:
                    return
                pairs += [(k, len(self.elements)) for k in range(len(self.elements))]
                self.elements.append(_Element(remainder, difference.factors))

    def _s_polynomial(self, x: _Element, y: _Element) -> _Element | None:
        """Return the S-polynomial: the difference of multiples with equal leading terms.

        None if its remainder is 0 by Buchberger's first criterion.
        """
        a, b = x.poly.monoms()[0], y.poly.monoms()[0]
        common = [max(m, n) for m, n in zip(a, b, strict=True)]
        if all(m == 0 or n == 0 for m, n in zip(a, b, strict=True)):
            return None
        factors: Sum = {}
        poly = self.ring.from_dict({})
        for element, leading, sign in ((x, a, 1), (y, b, -1)):
            power = tuple(m - n for m, n in zip(common, leading, strict=True))
            factor = self.ring.from_dict({power: sign / element.poly.coeffs()[0]})
            poly += factor * element.poly
            self._add(factors, factor, element.factors)
        return _Element(poly, factors)

    def _add(self, total: Sum, factor: fmpq_mpoly, factors: Sum) -> None:
        for number, x in factors.items():
            total[number] = total.get(number, self.ring.from_dict({})) + factor * x


# -- a certificate's residuals --------------------------------------------------------------------


def last_checked_power(entries: Expansion) -> int:
    """Return the last power of h that the theory's check covers."""
    if entries.last is not None:
        return entries.last
    return max(2 * entries.length, entries.convergence_order)


def factors_of(entries: Expansion) -> list[Factors]:
    """Return the factors of each residual, in order; the list is empty for a residual 0.

    Raises InputError if a residual is not shown to be 0.
    """
    functions = [function.name for function in entries.functions]
    # Outer functions come first: their relations contain inner ones, and not the other way round.
    names = [*reversed(functions), *entries.coordinates, "t", *entries.parameters]
    identities = Identities(entries)
    by_name = identities.relations
    relations = [
        (functions.index(name), by_name[name]) for name in reversed(functions) if name in by_name
    ]
    return Reducer(names, relations).all_factors(_residuals(identities))


def _residuals(identities: Identities) -> Iterator[Poly]:
    """Yield the theory's residuals, in which (k + 1) x_(k+1) is compared with X x_k."""
    entries, add = identities.entries, identities.add
    for coordinate, series in zip(entries.coordinates, entries.after, strict=True):
        coefficients = [*series, *({} for _ in range(entries.convergence_order + 1))]
        yield add(coefficients[0], {(coordinate,): Fraction(1)}, -1)
        for k in range(entries.convergence_order):
            scaled = {names: (k + 1) * c for names, c in coefficients[k + 1].items()}
            yield add(scaled, identities.along_flow(coefficients[k]), -1)
    for _, residual in (
        *identities.residuals_of_defect(last_checked_power(entries)),
        *identities.residuals_of_potential(),
    ):
        yield residual


class Reducer:
    """Writes polynomials in `names` as sums of multiples of numbered relations.

    The first names are eliminated first.
    """

    def __init__(self, names: Sequence[str], relations: Sequence[tuple[int, Poly]]) -> None:
        self.names, self.places = names, {name: k for k, name in enumerate(names)}
        # A certificate's names of functions, such as #1, are no names for the ring.
        plain = [f"x{k}" for k in range(len(names))]
        self.ring = fmpq_mpoly_ctx.get(plain, Ordering.lex)
        self.basis = Basis(self.ring, [(number, self.element(x)) for number, x in relations])

    def all_factors(self, residuals: Iterable[Poly]) -> list[Factors]:
        """Return the factors of each residual; InputError if one is not shown to be 0."""
        return [self.factors(residual) for residual in residuals]

    def element(self, x: Poly) -> fmpq_mpoly:
        """Return the polynomial as an element of the ring."""
        return polynomial_in(self.ring, self.places, x)

    def poly(self, x: fmpq_mpoly) -> Poly:
        """Return the element as a polynomial in the names."""
        total: Poly = {}
        for powers, c in x.to_dict().items():
            names = (n for n, k in zip(self.names, powers, strict=True) for _ in range(int(k)))
            total[tuple(sorted(names))] = Fraction(int(c.numerator), int(c.denominator))
        return total

    def factors(self, residual: Poly) -> Factors:
        """Return the factors of this residual; InputError if it is not shown to be 0."""
        sum_of_multiples = self.basis.find_sum(self.element(residual))
        if sum_of_multiples is None:
            raise InputError("certificate", NOT_GIVEN, "an identity is not seen by reducing")
        return [
            (number, self.poly(factor))
            for number, factor in sorted(sum_of_multiples.items())
            if factor
        ]
