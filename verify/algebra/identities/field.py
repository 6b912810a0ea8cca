"""A field of functions: quotients of polynomials in units, each of which knows its balls.

A unit is a name, π, or one function of quotients of older units: see the modules beside this one.
Polynomials are kept in normal form modulo the units' relations, such as ρ² = 1 + q². A quotient is
a function where its divisor is not 0; divisors come only from denominators of the expression that
is looked at, so where that is defined no divisor vanishes but where a common factor was left out.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.identities.polynomials import Poly, Polynomials, occurring, terms_of

Ball = flint.arb
_MOST_TERMS = 20_000
_MOST_WORK = 2_000_000  # products of two terms, all in all
_MOST_CANCELLED = 300  # terms of a quotient of which a common factor is looked for
_MOST_DEGREE = 300


# Gives balls for the names at one point, in flint's present precision.
Names = Callable[[], Mapping[str, flint.arb]]


class UndecidedError(Exception):
    """The identity is out of reach: too large, or made of what is not handled here."""


@dataclass(frozen=True)
class Algebraic:
    """What is known of an algebraic number a.

    `degrees`: by their places the units that it is made of, each with a bound of its degree over
    the older ones; `divisor`: a whole number d > 0 for which d·a is an algebraic integer; `house`:
    a bound of |a'| for every conjugate a'.
    """

    degrees: Mapping[int, int]
    divisor: int
    house: flint.arb

    @property
    def degree(self) -> int:
        """A bound of its degree."""
        return math.prod(self.degrees.values())


@dataclass(frozen=True)
class Unit:
    """One generator of the field.

    `ball` gives its value in flint's present precision, from those of older units and the names;
    `positive`: it is so wherever it is defined; `bounded`: it is between −1 and 1. `number`: of
    what is an algebraic number.
    """

    index: int
    ball: Callable[["Point"], Ball]
    positive: bool = False
    bounded: bool = False
    number: Algebraic | None = None


class Point:
    """The units' balls at one point: given by balls for the names."""

    def __init__(self, field: "Field", names: Mapping[str, Ball]) -> None:
        self.field, self.names = field, names
        self.values: dict[int, Ball] = {}

    def of(self, x: Poly) -> Ball:
        """The ball of a polynomial in the units."""
        total = flint.arb(0)
        places = occurring(x)
        for monomial, coefficient in terms_of(x):
            term = flint.arb(coefficient)
            for place in places:
                if monomial[place]:
                    term *= self.unit(place) ** int(monomial[place])
            total += term
        return total

    def unit(self, index: int) -> Ball:
        if index not in self.values:
            self.values[index] = self.field.units[index].ball(self)
        return self.values[index]

    def quotient(self, x: "Quotient") -> Ball:
        return self.of(x.above) / self.of(x.below)


class Field:
    """Quotients of polynomials in the names and in at most `room` more units."""

    def __init__(self, names: tuple[str, ...], room: int) -> None:
        self.ring = Polynomials(names, room)
        self.units: dict[int, Unit] = {}
        self.known: dict[tuple[str, ...], Quotient] = {}
        self.work = 0
        for name in names:
            place = self.ring.places[name]
            self.units[place] = Unit(place, lambda at, name=name: at.names[name])  # type: ignore[misc]
        self.zero, self.one = self.number(0), self.number(1)

    # -- elements -----------------------------------------------------------------------------

    def number(self, value: int | Fraction | flint.fmpq) -> "Quotient":
        if isinstance(value, Fraction):
            value = flint.fmpq(value.numerator, value.denominator)
        return Quotient(self, self.ring.context.constant(value), self.ring.one)

    def polynomial(self, x: Poly) -> "Quotient":
        return Quotient(self, self.ring.reduce(x), self.ring.one)

    def unit(
        self,
        key: tuple[str, ...],
        ball: Callable[[Point], Ball],
        *,
        positive: bool = False,
        bounded: bool = False,
        number: tuple[int, Algebraic] | None = None,
    ) -> "Quotient":
        """A new unit under a key that `known` does not have yet.

        `number`: its degree over the units in the second, which tells its divisor and house.
        """
        try:
            index = self.ring.made()
        except OverflowError:
            raise UndecidedError("too many functions") from None
        own = number and replace(number[1], degrees={**number[1].degrees, index: number[0]})
        self.units[index] = Unit(index, ball, positive, bounded, own)
        self.known[key] = self.polynomial(self.ring.gens[index])
        return self.known[key]

    def relate(self, unit: "Quotient", power: int, relation: Poly) -> None:
        """relation = 0, with that power of the unit, and older units; instead of an older one."""
        self.ring.relate(self.ring.gens[self.place(unit)], power, relation)

    def place(self, unit: "Quotient") -> int:
        """The place of a unit."""
        return occurring(unit.above)[0]

    def single(self, x: Poly) -> int | None:
        """The place of the unit that x is, with coefficient 1."""
        places = occurring(x)
        alone = len(x) == 1 and len(places) == 1 and x.total_degree() == 1
        return places[0] if alone and x.leading_coefficient() == 1 else None

    # -- arithmetic ---------------------------------------------------------------------------

    def multiplied(self, x: Poly, y: Poly) -> Poly:
        self.work += len(x) * len(y)
        if self.work > _MOST_WORK or x.total_degree() + y.total_degree() > 10 * _MOST_DEGREE:
            raise UndecidedError("too much work")
        return self.limit(self.ring.reduce(x * y))

    def limit(self, x: Poly) -> Poly:
        if len(x) > _MOST_TERMS:
            raise UndecidedError("too many terms")
        return x

    def made(self, above: Poly, below: Poly) -> "Quotient":
        """Their quotient without a common factor, as far as one is looked for."""
        if below.is_zero():
            raise UndecidedError("a division by zero")
        if above.is_zero():
            return self.zero
        if not below.is_constant() and self.is_small(above, below):
            common = above.gcd(below)
            if not common.is_constant():
                above, below = self.ring.reduce(above / common), self.ring.reduce(below / common)
        first = below.leading_coefficient()
        return Quotient(self, above / first, below / first)

    def is_small(self, *elements: Poly) -> bool:
        """Whether common factors and factors of it may be asked for."""
        terms = sum(len(x) for x in elements)
        return terms <= _MOST_CANCELLED and all(x.total_degree() <= _MOST_DEGREE for x in elements)

    def positive(self, place: int) -> bool:
        """Whether the unit of that place is > 0 wherever it is defined."""
        return self.units[place].positive

    def bounded(self, place: int) -> bool:
        """Whether it is between −1 and 1."""
        return self.units[place].bounded

    def is_number(self, x: Poly) -> bool:
        """Whether x is made of algebraic numbers alone."""
        return all(self.units[place].number is not None for place in occurring(x))

    def terms(self, x: "Quotient") -> Iterator[tuple[Fraction, "Quotient"]]:
        """x = Σ c·m with rational c, each m a power product over one divisor."""
        for monomial, c in terms_of(x.above):
            power_product = self.ring.context.from_dict({monomial: 1})
            # x.below begins with 1, so one m has one form only where nothing cancels.
            yield Fraction(int(c.p), int(c.q)), self.made(power_product, x.below)


@dataclass(frozen=True)
class Quotient:
    """above/below, polynomials in normal form."""

    field: Field
    above: Poly
    below: Poly

    @property
    def key(self) -> str:
        return f"{self.above}/{self.below}"

    @property
    def is_zero(self) -> bool:
        """Whether it is 0 as it stands; else it may be or not."""
        return bool(self.above.is_zero())

    @property
    def rational(self) -> flint.fmpq | None:
        """The rational number that it is."""
        if self.is_zero:
            return flint.fmpq(0)
        if self.above.is_constant() and self.below.is_constant():
            return self.above.leading_coefficient() / self.below.leading_coefficient()
        return None

    def __add__(self, other: "Quotient") -> "Quotient":
        f = self.field
        if self.below == other.below:
            return f.made(f.ring.reduce(self.above + other.above), self.below)
        crossed = f.multiplied(self.above, other.below) + f.multiplied(other.above, self.below)
        return f.made(crossed, f.multiplied(self.below, other.below))

    def __neg__(self) -> "Quotient":
        return Quotient(self.field, -self.above, self.below)

    def __sub__(self, other: "Quotient") -> "Quotient":
        return self + -other

    def __mul__(self, other: "Quotient") -> "Quotient":
        f = self.field
        return f.made(f.multiplied(self.above, other.above), f.multiplied(self.below, other.below))

    def __truediv__(self, other: "Quotient") -> "Quotient":
        return self * other.inverse()

    def inverse(self) -> "Quotient":
        return self.field.made(self.below, self.above)

    def __pow__(self, n: int) -> "Quotient":
        if n < 0:
            return self.inverse() ** -n
        if n < 2:
            return self if n else self.field.one
        half = self ** (n // 2)
        return half * half * self if n % 2 else half * half

    def times(self, c: int | Fraction | flint.fmpq) -> "Quotient":
        """Its product with a rational number."""
        if isinstance(c, Fraction):
            c = flint.fmpq(c.numerator, c.denominator)
        return Quotient(self.field, self.above * c, self.below) if c != 0 else self.field.zero
