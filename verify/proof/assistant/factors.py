"""Factors by which the gaps of a certificate for one H are seen to be 0: gap = Σ factor·relation.

The relations are those of the theory, one for each function: sin² + cos² = 1 and u·(1/u) = 1. The
gaps are the theory's too (`Identities.v`), in its order. What the certificate holds of the like is
of other gaps, where D is applied to a coordinate over and over.

Polynomials as sums of multiples of relations: by dividing, and where that is not enough, by a
Gröbner basis whose elements are known as such sums themselves (Buchberger's algorithm).
"""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx

from verify.errors import NOT_GIVEN, InputError
from verify.proof.certificates.by_coefficients import polynomial
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion
from verify.proof.certificates.readers import Poly

_MOST_PAIRS = 2000  # of which a difference is looked at
_MOST_TERMS = 20_000  # of a factor

Sum = dict[int, fmpq_mpoly]  # factors, by the numbers of their relations


class _Element(NamedTuple):
    """A polynomial, and what it is a sum of."""

    poly: fmpq_mpoly
    by: Sum


class Basis:
    """Relations, each with its number, of polynomials in one ring."""

    def __init__(self, ring: fmpq_mpoly_ctx, relations: Iterable[tuple[int, fmpq_mpoly]]) -> None:
        self.ring = ring
        one = ring.constant(1)
        self.elements = [_Element(x, {number: one}) for number, x in relations if x]
        self.complete = False

    def sum_of(self, x: fmpq_mpoly) -> Sum | None:
        """The polynomial as a sum of multiples of the relations; None where none is found."""
        left, found = self._divided(x)
        if left and not self.complete:
            self._complete()
            left, found = self._divided(x)
        return None if left else found

    def _divided(self, x: fmpq_mpoly) -> tuple[fmpq_mpoly, Sum]:
        found: Sum = {}
        changed = True
        while changed and x:
            changed = False
            for element in self.elements:
                quotient, x = divmod(x, element.poly)
                if quotient:
                    changed = True
                    self._add(found, quotient, element.by)
        return x, found

    def _complete(self) -> None:
        """Adds differences of multiples until each of them is a sum of multiples."""
        self.complete = True
        pairs = list(combinations(range(len(self.elements)), 2))
        for _ in range(_MOST_PAIRS):
            if not pairs:
                return
            i, j = pairs.pop(0)
            difference = self._difference(self.elements[i], self.elements[j])
            if difference is None:
                continue
            left, found = self._divided(difference.poly)
            if left:
                self._add(difference.by, self.ring.constant(-1), found)
                if sum(map(len, difference.by.values())) > _MOST_TERMS:
                    return
                pairs += [(k, len(self.elements)) for k in range(len(self.elements))]
                self.elements.append(_Element(left, difference.by))

    def _difference(self, x: _Element, y: _Element) -> _Element | None:
        """Of multiples whose leading terms are the same; None where it is known to be a sum."""
        a, b = x.poly.monoms()[0], y.poly.monoms()[0]
        common = [max(m, n) for m, n in zip(a, b, strict=True)]
        if all(m == 0 or n == 0 for m, n in zip(a, b, strict=True)):
            return None  # Buchberger's first criterion
        by: Sum = {}
        poly = self.ring.from_dict({})
        for element, own, sign in ((x, a, 1), (y, b, -1)):
            power = tuple(m - n for m, n in zip(common, own, strict=True))
            factor = self.ring.from_dict({power: sign / element.poly.coeffs()[0]})
            poly += factor * element.poly
            self._add(by, factor, element.by)
        return _Element(poly, by)

    def _add(self, to: Sum, factor: fmpq_mpoly, by: Sum) -> None:
        for number, x in by.items():
            to[number] = to.get(number, self.ring.from_dict({})) + factor * x


Factors = list[tuple[int, Poly]]  # each with the number of its relation


def known_power(entries: Expansion) -> int:
    """The last power of h of which the theory's check says anything."""
    if entries.last is not None:
        return entries.last
    return max(2 * entries.length, entries.convergence_order)


def factors_of(entries: Expansion) -> list[Factors]:
    """Those of each gap, in order; of a gap that is 0 as it stands there are none.

    Raises InputError where a gap is not seen to be 0.
    """
    made = [function.name for function in entries.functions]
    # Outer functions first: they bring inner ones, which do not bring outer ones.
    names = [*reversed(made), *entries.coordinates, "t", *entries.parameters]
    identities = Identities(entries)
    found = identities.relations
    relations = [(made.index(name), found[name]) for name in reversed(made) if name in found]
    return Reducer(names, relations).all_factors(_gaps(identities))


def _gaps(identities: Identities) -> Iterator[Poly]:
    """What has to be 0 in the theory's words, where Xⁿz/n! is made of the coefficient before it."""
    given, add = identities.given, identities.add
    for by, series in zip(given.coordinates, given.after, strict=True):
        own = [*series, *({} for _ in range(given.convergence_order + 1))]
        yield add(own[0], {(by,): Fraction(1)}, -1)
        for k in range(given.convergence_order):
            scaled = {names: (k + 1) * c for names, c in own[k + 1].items()}
            yield add(scaled, identities.along_flow(own[k]), -1)
    for _, gap in (*identities.gaps_of_defect(known_power(given)), *identities.gaps_of_potential()):
        yield gap


class Reducer:
    """Polynomials reduced by relations, each with its number, in their order.

    `names`: what is made away with first stands first.
    """

    def __init__(self, names: Sequence[str], relations: Sequence[tuple[int, Poly]]) -> None:
        self.names, self.places = names, {name: k for k, name in enumerate(names)}
        # The ring's own names: what a certificate calls a function is no name there.
        plain = [f"x{k}" for k in range(len(names))]
        self.ring = fmpq_mpoly_ctx.get(plain, Ordering.lex)
        self.basis = Basis(self.ring, [(number, self.element(x)) for number, x in relations])

    def all_factors(self, gaps: Iterable[Poly]) -> list[Factors]:
        """Those of each gap; InputError where one is not seen to be 0."""
        return [self.factors(gap) for gap in gaps]

    def element(self, x: Poly) -> fmpq_mpoly:
        """The polynomial in the ring."""
        return polynomial(self.ring, self.places, x)

    def poly(self, x: fmpq_mpoly) -> Poly:
        """The element as a polynomial in the names."""
        found: Poly = {}
        for powers, c in x.to_dict().items():
            names = (n for n, k in zip(self.names, powers, strict=True) for _ in range(int(k)))
            found[tuple(sorted(names))] = Fraction(int(c.numerator), int(c.denominator))
        return found

    def factors(self, gap: Poly) -> Factors:
        """The factors of this gap."""
        found = self.basis.sum_of(self.element(gap))
        if found is None:
            raise InputError("certificate", NOT_GIVEN, "an identity is not seen by reducing")
        return [(number, self.poly(factor)) for number, factor in sorted(found.items()) if factor]
