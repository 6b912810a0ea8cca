"""Power series in h cut off after hⁿ, and functions of (p, q) at a point given by such series.

A function's Taylor series around (p, q) needs nothing but its partial derivatives, so that
f(p + u, q + v) with u, v = O(h) is exact in every coefficient that is kept, whatever f is made of;
no closed form of a composition is written down on the way.

What power series and forms are made over: a ring of functions with derivatives.

`verify.algebra.ring.Ring` is one, in which zero is decided; the jets of every H are another, in
which zero is the zero polynomial.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from verify.algebra.generator import Poly
from verify.algebra.zero_test import Decision


class CoefficientRing(Protocol):
    """See the module's text."""

    @property
    def zero(self) -> Poly:
        """0."""

    @property
    def one(self) -> Poly:
        """1."""

    @property
    def places(self) -> Mapping[str, int]:
        """The variables by their names."""

    def reduce(self, x: Poly) -> Poly:
        """x in normal form."""

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """The product in normal form."""

    def constant(self, value: Fraction) -> Poly:
        """A rational number as an element."""

    def variable(self, name: str) -> Poly:
        """A variable as an element."""

    def diff(self, x: Poly, name: str) -> Poly:
        """The partial derivative by a variable."""

    def decide(self, x: Poly) -> Decision:
        """Whether x is the zero function."""

    def vanishes(self, x: Poly) -> bool | None:
        """The same, without a witness."""

    def text(self, x: Poly) -> str:
        """x as a formula."""


@dataclass(frozen=True)
class Series:
    """Σ hᵏ coefficients[k], the coefficients in normal form in `ring` and free of h."""

    ring: CoefficientRing
    coefficients: tuple[Poly, ...]

    @classmethod
    def of(cls, ring: CoefficientRing, coefficients: Sequence[Poly], most: int) -> "Series":
        """With these first coefficients, as far as h^most."""
        kept = [*coefficients[: most + 1], *[ring.zero] * (most + 1 - len(coefficients))]
        return cls(ring, tuple(kept))

    @property
    def most(self) -> int:
        """The highest power of h that is kept."""
        return len(self.coefficients) - 1

    def __add__(self, other: "Series") -> "Series":
        pairs = zip(self.coefficients, other.coefficients, strict=True)
        return Series(self.ring, tuple(x + y for x, y in pairs))

    def __sub__(self, other: "Series") -> "Series":
        return self + other.times(Fraction(-1))

    def __radd__(self, number: int) -> "Series":
        first, *others = self.coefficients
        return Series(self.ring, (first + number, *others))

    def __rsub__(self, number: int) -> "Series":
        return number + self.times(Fraction(-1))

    def __mul__(self, other: "Series") -> "Series":
        ring, most = self.ring, self.most
        total = [ring.zero] * (most + 1)
        for i, x in enumerate(self.coefficients):
            if not x.is_zero():
                for j, y in enumerate(other.coefficients[: most + 1 - i]):
                    if not y.is_zero():
                        total[i + j] += x * y
        return Series(ring, tuple(map(ring.reduce, total)))

    def over(self, divisor: "Series", inverse: Poly) -> "Series":
        """Its quotient by a series whose first coefficient has this inverse."""
        ring = self.ring
        found: list[Poly] = []
        for k, total in enumerate(self.coefficients):
            for j in range(1, k + 1):
                if not divisor.coefficients[j].is_zero():
                    total = total - divisor.coefficients[j] * found[k - j]
            found.append(ring.multiply(ring.reduce(total), inverse))
        return Series(ring, tuple(found))

    @property
    def vanishes(self) -> bool:
        """Whether all coefficients that are kept are 0."""
        return all(c.is_zero() for c in self.coefficients)

    def times(self, x: Poly | Fraction) -> "Series":
        """Its product with what does not depend on h."""
        factor = self.ring.constant(x) if isinstance(x, Fraction) else x
        multiply = self.ring.multiply
        return Series(
            self.ring, tuple(c if c.is_zero() else multiply(factor, c) for c in self.coefficients)
        )

    def shifted(self, n: int) -> "Series":
        """Its product with hⁿ."""
        return Series.of(self.ring, [*[self.ring.zero] * n, *self.coefficients], self.most)

    def diff(self, name: str) -> "Series":
        """∂/∂name of each coefficient."""
        return Series(self.ring, tuple(self.ring.diff(c, name) for c in self.coefficients))


class Derivatives:
    """A ring element, with its derivatives, each made once."""

    def __init__(self, ring: CoefficientRing, element: Poly) -> None:
        self.ring, self.element = ring, element
        self._known: dict[str, Derivatives] = {}

    def by(self, name: str) -> "Derivatives":
        """∂/∂name, with its own derivatives."""
        if name not in self._known:
            self._known[name] = Derivatives(self.ring, self.ring.diff(self.element, name))
        return self._known[name]

    def partial(self, i: int, j: int) -> Poly:
        """∂ⁱ⁺ʲ/∂pⁱ∂qʲ of it, of a function of p and q."""
        found = self
        for name in "p" * i + "q" * j:
            found = found.by(name)
        return found.element


def at_moved(x: Derivatives, moves: Sequence[tuple[str, Series]], most: int) -> Series:
    """The ring element x, up to h^most, where each variable of a name is moved by its series, O(h).

    By Taylor's formula, one variable after the other, so that an x with few of them is soon done.
    """
    ring = x.ring
    cut = [(name, Series.of(ring, by.coefficients, most)) for name, by in moves]
    for name, by in cut:
        if not by.coefficients[0].is_zero():
            raise ValueError(f"{name} is moved at h = 0")
    terms = _taylor_terms(x, cut, Series.of(ring, [ring.one], most), Fraction(1))
    return sum(terms, Series.of(ring, [], most))


def _taylor_terms(
    x: Derivatives, moves: Sequence[tuple[str, Series]], power: Series, share: Fraction
) -> Iterator[Series]:
    """Of x and its derivatives by these variables, times the power of what stands before."""
    if not moves:
        yield power.times(x.element * x.ring.constant(share))
        return
    (name, by), *rest = moves
    n = 0
    while not (x.element.is_zero() or power.vanishes):
        yield from _taylor_terms(x, rest, power, share)
        n += 1
        x, power, share = x.by(name), power * by, share / n
