"""The chain Λ₀ … Λ₄, or that of an entry of W, for one step size, and its parts.

`verify.studies.separation.truncation_and_rounding` defines the links. A link is a trail of values
at a run's checkpoints: rationals over one common denominator. A separation subtracts, compares and
takes maxima of tens of thousands of values, and nearly all of them are whole multiples of one power
of 2. With a common denominator each of these is an operation of integers.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from math import lcm
from typing import Any, Literal

from verify.arithmetic.exact import magnitude
from verify.scenes.results.separation_parts import Parts

Kind = Literal["enclosed", "estimated"]
PARTS = Parts.rounding  # the names of the plane's rounding parts, in the chain's order
_WHOLES = ("lambda_working", "truncation", "total")
QUANTITIES = (*_WHOLES, *PARTS)


class Trail(Sequence[Fraction]):
    """Rationals, each one of `numerators` over `denominator`; Fractions are made on access."""

    __slots__ = ("denominator", "numerators")

    def __init__(self, numerators: Iterable[int], denominator: int) -> None:
        self.numerators, self.denominator = tuple(numerators), denominator

    @classmethod
    def from_values(cls, values: Iterable[Fraction]) -> "Trail":
        """Return a trail of these values."""
        if isinstance(values, Trail):
            return values
        numbers = tuple(values)
        common = lcm(*{x.denominator for x in numbers})
        return cls((x.numerator * (common // x.denominator) for x in numbers), common)

    def __len__(self) -> int:
        return len(self.numerators)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return Trail(self.numerators[index], self.denominator)
        return Fraction(self.numerators[index], self.denominator)

    def __iter__(self) -> Iterator[Fraction]:
        return (Fraction(n, self.denominator) for n in self.numerators)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Trail):
            return NotImplemented
        numerators, other_numerators, _ = self._over_common_denominator(other)
        return numerators == other_numerators

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __sub__(self, other: "Trail") -> "Trail":
        """Subtract value by value."""
        minuends, subtrahends, common = self._over_common_denominator(other)
        return Trail((a - b for a, b in zip(minuends, subtrahends, strict=True)), common)

    def __repr__(self) -> str:
        return f"Trail({self.numerators}, {self.denominator})"

    @property
    def largest(self) -> Fraction:
        """The greatest absolute value."""
        return Fraction(max(map(abs, self.numerators)), self.denominator)

    def envelope(self) -> "Trail":
        """Return the greatest absolute value so far, at every checkpoint."""
        return Trail(accumulate(map(abs, self.numerators), max), self.denominator)

    def above(self, least: Fraction) -> list[int]:
        """Return the places of the values that are greater than this one."""
        # A whole number exceeds x exactly where it exceeds ⌊x⌋.
        bound = least.numerator * self.denominator // least.denominator
        return [k for k, n in enumerate(self.numerators) if n > bound]

    def _over_common_denominator(
        self, other: "Trail"
    ) -> tuple[tuple[int, ...], tuple[int, ...], int]:
        """Return both numerators over one denominator, and the denominator."""
        common = lcm(self.denominator, other.denominator)
        return self._over(common), other._over(common), common

    def _over(self, denominator: int) -> tuple[int, ...]:
        factor = denominator // self.denominator
        return self.numerators if factor == 1 else tuple(n * factor for n in self.numerators)


@dataclass(frozen=True)
class Link:
    """Λ, or an entry of W, at every checkpoint, each value within `bound` of the exact one.

    Two links that a proof shows to be equal are the same object.
    """

    trail: Trail
    bound: Fraction
    kind: Kind
    method: str


Links = tuple[Link, ...]  # one for Λ, or one for each entry of W above its diagonal, row by row
Entries = tuple[Fraction, ...]  # the values of such links at one checkpoint


def links_of(values: Iterable[Entries], bound: Fraction, kind: Kind, method: str) -> Links:
    """Return a link for each entry, from all entries at every checkpoint."""
    return tuple(
        Link(Trail.from_values(entry), bound, kind, method) for entry in zip(*values, strict=True)
    )


def exact_links(values: Iterable[Entries], method: str) -> Links:
    """Return links of exact values."""
    return links_of(values, Fraction(0), "enclosed", method)


@dataclass(frozen=True)
class Chain:
    """The chain Λ₀ … Λ₄ of one way to evaluate Λ in float64, at the numbers of steps in `marks`.

    `parts`: the names of the rounding parts, one between each link and the next.
    """

    marks: tuple[int, ...]
    links: tuple[Link, ...]
    parts: tuple[str, ...] = PARTS

    @property
    def quantities(self) -> tuple[str, ...]:
        """The names of Λ, truncation, rounding, and its parts."""
        return *_WHOLES, *self.parts

    def trail(self, name: str) -> tuple[Trail, Fraction]:
        """Return a quantity of `quantities` at every checkpoint, and a bound of its error.

        truncation + all parts = lambda_working, exactly.
        """
        before, after = self._ends(name)
        last = self.links[after]
        if before is None:
            return last.trail, last.bound
        first = self.links[before]
        # Equal links are one object, whose difference from itself is exactly 0.
        bound = Fraction(0) if first is last else first.bound + last.bound
        return last.trail - first.trail, bound

    def final(self, name: str) -> tuple[Fraction, Fraction]:
        """Return a quantity after the last step, and the bound of its error."""
        trail, bound = self.trail(name)
        return trail[-1], bound

    def _ends(self, name: str) -> tuple[int | None, int]:
        """Return the indices of the links whose difference a quantity is.

        None in place of the first: the quantity is the second link itself.
        """
        if name in self.parts:
            k = self.parts.index(name)
            return k, k + 1
        last = len(self.parts)
        return {"lambda_working": (None, last), "truncation": (None, 0), "total": (0, last)}[name]

    def lacking(self, digits: int, least: Fraction = Fraction(0)) -> list[int]:
        """Return the number of digits that each link lacks for `digits` digits of its parts.

        A part of which no more is required than that it is at most `least` lacks none.
        """
        lacking = [0] * len(self.links)
        for name in self.quantities:
            value, bound = self.final(name)
            if not (abs(value) > least and bound):
                continue
            # Two links share a part's error: each may have a quarter of a unit of the last digit.
            tolerance = abs(value) / (4 * Fraction(10) ** digits)
            for k in (end for end in self._ends(name) if end is not None):
                excess = self.links[k].bound / tolerance
                if excess > 1:
                    lacking[k] = max(lacking[k], magnitude(excess) + 1)
        return lacking

    @property
    def kind(self) -> Kind:
        """Enclosed where the bound of every link is proved, else estimated."""
        return "enclosed" if all(x.kind == "enclosed" for x in self.links) else "estimated"

    @property
    def methods(self) -> tuple[str, ...]:
        """The methods that bounded the errors of all links but the last, each once."""
        return tuple(dict.fromkeys(link.method for link in self.links[:-1]))


def lacking(chains: Sequence[Chain], digits: int, hidden: int | None = None) -> list[int]:
    """Return the number of digits that each link lacks, in the chain in which it lacks most.

    `hidden`: a part that is `digits` + `hidden` digits below the greatest one may stay unknown.
    """
    least = Fraction(0)
    if hidden is not None:
        largest = max(abs(chain.final(name)[0]) for chain in chains for name in chain.quantities)
        least = largest / Fraction(10) ** (digits + hidden)
    digits_of_links = zip(*(chain.lacking(digits, least) for chain in chains), strict=True)
    return [max(digits_of_link) for digits_of_link in digits_of_links]
