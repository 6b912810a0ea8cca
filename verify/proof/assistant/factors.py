"""Factors by which the gaps of a certificate for one H are seen to be 0: gap = Σ factor·relation.

The relations are those of the theory, one for each function: sin² + cos² = 1 and u·(1/u) = 1. The
gaps are the theory's too (`Identities.v`), in its order. What the certificate holds of the like is
of other gaps, where D is applied to a coordinate over and over.
"""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from verify.errors import NOT_GIVEN, InputError
from verify.proof.assistant.basis import Basis
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion
from verify.proof.certificates.readers import Poly

Factors = list[tuple[int, Poly]]  # each with the number of its relation


def known_power(entries: Expansion) -> int:
    """The last power of h of which the theory's check says anything."""
    if entries.last is not None:
        return entries.last
    return max(2 * max(map(len, entries.after)), entries.convergence_order)


def factors_of(entries: Expansion) -> list[Factors]:
    """Those of each gap, in order; of a gap that is 0 as it stands there are none.

    Raises InputError where a gap is not seen to be 0.
    """
    made = [function.name for function in entries.functions]
    # Outer functions first: they bring inner ones, which do not bring outer ones.
    names = [*reversed(made), *entries.coordinates, "t", *entries.parameters]
    found = Identities(entries).relations
    relations = [(made.index(name), found[name]) for name in reversed(made) if name in found]
    return Reducer(names, relations).all_factors(_Gaps(entries).collected())


class _Gaps(Identities):
    """The checker's identities: what has to be 0 is collected in place of being looked at."""

    def __init__(self, entries: Expansion) -> None:
        super().__init__(entries)
        self.gaps: list[Poly] = []

    def zero(self, x: Poly, what: str) -> None:
        self.gaps.append(x)

    def collected(self) -> Iterator[Poly]:
        given = self.given
        for by, series in zip(given.coordinates, given.after, strict=True):
            own = [*series, *({} for _ in range(given.convergence_order + 1))]
            yield self.add(own[0], {(by,): Fraction(1)}, -1)
            for k in range(given.convergence_order):
                scaled = {names: (k + 1) * c for names, c in own[k + 1].items()}
                yield self.add(scaled, self.along_flow(own[k]), -1)
        self.check_defect(known_power(given))
        if given.potential is not None:
            self.check_potential(given.potential)
        yield from self.gaps


class Reducer:
    """Polynomials reduced by relations, each with its number, in their order.

    `names`: what is made away with first stands first.
    """

    def __init__(self, names: Sequence[str], relations: Sequence[tuple[int, Poly]]) -> None:
        self.names = names
        # The ring's own names: what a certificate calls a function is no name there.
        plain = [f"x{k}" for k in range(len(names))]
        self.ring = fmpq_mpoly_ctx.get(plain, Ordering.lex)
        self.basis = Basis(self.ring, [(number, self.element(x)) for number, x in relations])

    def all_factors(self, gaps: Iterable[Poly]) -> list[Factors]:
        """Those of each gap; InputError where one is not seen to be 0."""
        return [self.factors(gap) for gap in gaps]

    def element(self, x: Poly) -> fmpq_mpoly:
        """The polynomial in the ring."""
        terms = {
            tuple(names.count(name) for name in self.names): fmpq(c.numerator, c.denominator)
            for names, c in x.items()
        }
        return self.ring.from_dict(terms)

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
