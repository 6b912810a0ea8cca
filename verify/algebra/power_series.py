"""Power series in h truncated after hⁿ, and functions of (p, q) at a point given by such series.

The Taylor series of f around (p, q) needs only partial derivatives of f. So f(p + u, q + v) with
u, v = O(h) is exact in every kept coefficient, for any f, without a closed form of the composition.

The coefficients are elements of a ring of functions with derivatives: `verify.algebra.ring.Ring`,
in which zero is decided, or the jets of every H, in which only the zero polynomial is zero.

The step of a scheme that solves linear equations is a quotient of polynomials in h. With
D = d₀ + d₁ h + …, d₀ a number, the series r₀ + r₁ h + … of 1/D has r₀ = 1/d₀ and
r_n = −(d₁ r_{n−1} + … + d_n r₀)/d₀. A step that turns has functions such as sin(h a), whose series
is that of Taylor at 0. Derivatives of either, which have more and more terms, are not needed.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Protocol

from verify.algebra.formula import function, symbol
from verify.algebra.identities.polynomials import Poly, split
from verify.algebra.ring import Ring
from verify.algebra.zero_test import Decision
from verify.functions import in_rings
from verify.lazy_sympy import sympy


class CoefficientRing(Protocol):
    """A ring of functions with derivatives (see the module's docstring)."""

    @property
    def zero(self) -> Poly:
        """The element 0."""

    @property
    def one(self) -> Poly:
        """The element 1."""

    @property
    def places(self) -> Mapping[str, int]:
        """The places of the variables, by name."""

    def reduce(self, x: Poly) -> Poly:
        """Return x in normal form."""

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """Return the product in normal form."""

    def constant(self, value: Fraction) -> Poly:
        """Convert a rational number to an element."""

    def variable(self, name: str) -> Poly:
        """Return a variable as an element."""

    def diff(self, x: Poly, name: str) -> Poly:
        """Return the partial derivative by a variable."""

    def decide(self, x: Poly) -> Decision:
        """Decide whether x is the zero function."""

    def vanishes(self, x: Poly) -> bool | None:
        """Return True if x is zero, False if not, None if undecided; without a witness."""

    def text(self, x: Poly) -> str:
        """Format x as a formula."""


@dataclass(frozen=True)
class Series:
    """The series Σ hᵏ coefficients[k]; the coefficients are in normal form, and do not have h."""

    ring: CoefficientRing
    coefficients: tuple[Poly, ...]

    @classmethod
    def from_coefficients(
        cls, ring: CoefficientRing, coefficients: Sequence[Poly], most: int
    ) -> "Series":
        """Return the series up to h^most with these first coefficients, and 0 for the others."""
        padded = [*coefficients[: most + 1], *[ring.zero] * (most + 1 - len(coefficients))]
        return cls(ring, tuple(padded))

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
                    # Terms beyond h^most are not formed; the sums are reduced once, at the end.
                    if not y.is_zero():
                        total[i + j] += x * y
        return Series(ring, tuple(map(ring.reduce, total)))

    def divide_by(self, divisor: "Series", inverse: Poly) -> "Series":
        """Return the quotient by a series; `inverse` is the inverse of its first coefficient."""
        ring = self.ring
        quotient: list[Poly] = []
        # From Σ d_j c_(k−j) = x_k: c_k = (x_k − Σ_(j≥1) d_j c_(k−j))/d_0.
        for k, total in enumerate(self.coefficients):
            for j in range(1, k + 1):
                if not divisor.coefficients[j].is_zero():
                    total = total - divisor.coefficients[j] * quotient[k - j]
            quotient.append(ring.multiply(ring.reduce(total), inverse))
        return Series(ring, tuple(quotient))

    @property
    def vanishes(self) -> bool:
        """True if all coefficients of the truncated series are 0."""
        return all(c.is_zero() for c in self.coefficients)

    def times(self, x: Poly | Fraction) -> "Series":
        """Return the product with a factor that does not depend on h."""
        factor = self.ring.constant(x) if isinstance(x, Fraction) else x
        multiply = self.ring.multiply
        return Series(
            self.ring, tuple(c if c.is_zero() else multiply(factor, c) for c in self.coefficients)
        )

    def shift(self, n: int) -> "Series":
        """Return the product with hⁿ."""
        return Series.from_coefficients(
            self.ring, [*[self.ring.zero] * n, *self.coefficients], self.most
        )

    def diff(self, name: str) -> "Series":
        """Return the series of ∂/∂name of each coefficient."""
        return Series(self.ring, tuple(self.ring.diff(c, name) for c in self.coefficients))


class Derivatives:
    """A ring element with its derivatives, which are cached."""

    def __init__(self, ring: CoefficientRing, element: Poly) -> None:
        self.ring, self.element = ring, element
        self._derivatives: dict[str, Derivatives] = {}

    def by(self, name: str) -> "Derivatives":
        """Return ∂/∂name of the element, with the further derivatives."""
        if name not in self._derivatives:
            self._derivatives[name] = Derivatives(self.ring, self.ring.diff(self.element, name))
        return self._derivatives[name]

    def partial(self, i: int, j: int) -> Poly:
        """Return ∂ⁱ⁺ʲ/∂pⁱ∂qʲ of the element, a function of p and q."""
        derivative = self
        for name in "p" * i + "q" * j:
            derivative = derivative.by(name)
        return derivative.element


def expand_at(x: Derivatives, moves: Sequence[tuple[str, Series]], most: int) -> Series:
    """Return the series of the ring element x at a moved point, up to h^most.

    `moves`: (name, displacement) of the variables; a displacement is a series that is O(h).
    Taylor's formula is applied to one variable after the other, which is fast if x has few.
    """
    ring = x.ring
    truncated = [
        (name, Series.from_coefficients(ring, move.coefficients, most)) for name, move in moves
    ]
    for name, move in truncated:
        if not move.coefficients[0].is_zero():
            raise ValueError(f"{name} is moved at h = 0")
    terms = _taylor_terms(
        x, truncated, Series.from_coefficients(ring, [ring.one], most), Fraction(1)
    )
    return sum(terms, Series.from_coefficients(ring, [], most))


def _taylor_terms(
    x: Derivatives, moves: Sequence[tuple[str, Series]], power: Series, share: Fraction
) -> Iterator[Series]:
    """Yield the terms of Taylor's formula in these variables, each times `power` and `share`."""
    if not moves:
        yield power.times(x.element * x.ring.constant(share))
        return
    (name, move), *further_moves = moves
    n = 0
    # move = O(h), so `power` vanishes after at most `most` + 1 factors, even if x is no polynomial.
    while not (x.element.is_zero() or power.vanishes):
        yield from _taylor_terms(x, further_moves, power, share)
        n += 1
        x, power, share = x.by(name), power * move, share / n


@lru_cache(maxsize=64)
def _taylor_numbers(name: str, most: int) -> list[Fraction] | None:
    """Return the Taylor coefficients at 0 of a function, up to that of x^most; None if it has
    others than rational numbers there."""
    x = symbol("x")
    derivative, numbers = function(name)(x), []
    for n in range(most + 1):
        value = derivative.subs(x, 0)
        if not value.is_Rational:
            return None
        numbers.append(Fraction(int(value.p), int(value.q) * math.factorial(n)))
        derivative = derivative.diff(x)
    return numbers


class QuotientSeries:
    """An expander of a ring's elements in powers of h, up to `length` coefficients."""

    def __init__(self, ring: Ring, length: int) -> None:
        self.ring, self.most = ring, length - 1
        self._by_index = {g.index: g for g in ring.generators}
        self._cache: dict[int, Series | None] = {}

    def expand(self, x: Poly) -> Series | None:
        """Return the series of x; None if at h = 0 a divisor with h is no number ≠ 0, a radicand no
        power of a rational one, or the argument of another function not 0."""
        inner = self._with_h(x)
        if inner is None:
            powers = self.ring.powers(x, "h")
            return self._series([powers.get(n, self.ring.zero) for n in range(self.most + 1)])
        value = self._value(inner)
        if value is None:
            return None
        total, factor, power = self._series([]), self._series([self.ring.one]), 0
        for n, coefficient in sorted(split(x, inner).items()):
            while power < n:
                factor, power = factor * value, power + 1
            part = self.expand(coefficient)
            if part is None:
                return None
            total += part * factor
        return total

    def _series(self, coefficients: list[Poly]) -> Series:
        return Series.from_coefficients(self.ring, coefficients, self.most)

    def _with_h(self, x: Poly) -> int | None:
        """Return the index of the newest generator in x whose argument has h; None if there is
        none."""
        degrees = x.degrees()
        for g in reversed(self.ring.generators):
            if degrees[g.index] and g.argument is not None and self.ring.depends(g.argument, "h"):
                return g.index
        return None

    def _value(self, index: int) -> Series | None:
        """Return the series of a generator."""
        if index not in self._cache:
            g = self._by_index[index]
            inner = self.expand(g.inner)
            if inner is None:
                self._cache[index] = None
            elif g.kind == "inverse":
                self._cache[index] = self._one_over(inner)
            elif g.kind == "root":
                self._cache[index] = self._root(inner, g.degree)
            else:
                numbers = _taylor_numbers(g.kind, self.most) if g.kind in in_rings() else None
                self._cache[index] = self._series_at(numbers, inner)
        return self._cache[index]

    def _root(self, inner: Series, degree: int) -> Series | None:
        """Return the root of c + O(h), c the power of a rational number; None for another series.

        It is r (1 + x)^(1/n), rⁿ = c, with binomial coefficients.
        """
        first = inner.coefficients[0]
        if not first.is_constant() or first.is_zero():
            return None
        c = first.leading_coefficient()
        root = sympy.Rational(int(c.p), int(c.q)) ** sympy.Rational(1, degree)
        if not (root.is_Rational and root > 0):
            return None
        numbers = [Fraction(int(root.p), int(root.q))]
        for n in range(self.most):
            numbers.append(numbers[-1] * (Fraction(1, degree) - n) / (n + 1))
        share = inner.times(Fraction(int(c.q), int(c.p)))
        return self._series_at(numbers, share - self._series([self.ring.one]))

    def _series_at(self, numbers: list[Fraction] | None, inner: Series) -> Series | None:
        """Return Σ numbers[n] xⁿ for a series x that is O(h); None for another series."""
        if numbers is None or not inner.coefficients[0].is_zero():
            return None
        total, power = self._series([]), self._series([self.ring.one])
        for number in numbers:
            total, power = total + power.times(number), power * inner
        return total

    def _one_over(self, divisor: Series) -> Series | None:
        d0 = divisor.coefficients[0]
        # The recursion divides by d₀ in every order: it must be a number other than 0.
        if d0.is_zero() or not d0.is_constant():
            return None
        inverse = 1 / d0.leading_coefficient()
        return self._series([self.ring.one]).divide_by(divisor, self.ring.one * inverse)
