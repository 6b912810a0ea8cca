"""Values at a run's checkpoints, as exact rationals over one denominator, and links of them.

A separation subtracts, compares and takes maxima of tens of thousands of them, and nearly all are
whole multiples of one power of 2: so each of these is an operation of integers.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from math import lcm
from typing import Any, Literal

Kind = Literal["enclosed", "estimated"]


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
        mine, theirs, _ = self._over_common_denominator(other)
        return mine == theirs

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __sub__(self, other: "Trail") -> "Trail":
        """Subtract value by value."""
        mine, theirs, common = self._over_common_denominator(other)
        return Trail((a - b for a, b in zip(mine, theirs, strict=True)), common)

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


Links = tuple[Link, ...]  # of Λ alone, or one for each entry of W above its diagonal, row by row
Entries = tuple[Fraction, ...]  # the values of these at one checkpoint


def links_of(values: Iterable[Entries], bound: Fraction, kind: Kind, method: str) -> Links:
    """Return a link for each entry, from all entries at every checkpoint."""
    return tuple(
        Link(Trail.from_values(each), bound, kind, method) for each in zip(*values, strict=True)
    )


def exact_links(values: Iterable[Entries], method: str) -> Links:
    """Return links of exact values."""
    return links_of(values, Fraction(0), "enclosed", method)
