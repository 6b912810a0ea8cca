"""Polynomials as sums of multiples of relations: by dividing, and where that is not enough, by a
Gröbner basis whose elements are known as such sums themselves (Buchberger's algorithm)."""

from collections.abc import Iterable
from itertools import combinations
from typing import NamedTuple

from flint import fmpq_mpoly, fmpq_mpoly_ctx

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
