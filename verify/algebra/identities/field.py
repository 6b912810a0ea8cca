"""A field of functions: quotients of polynomials in units, each of which can be enclosed.

A unit is a name, π, or a function of quotients of older units (see the modules in this folder).
Polynomials are in normal form modulo the units' relations, such as ρ² = 1 + q². A quotient is a
function wherever its divisor is not 0. Divisors come only from denominators of the examined
expression: where it is defined, no divisor vanishes, except where a common factor was cancelled.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.identities.polynomials import Poly, Polynomials, places_in, terms_of

Ball = flint.arb
_MAX_TERMS = 20_000
_MAX_WORK = 2_000_000  # products of two terms over the life of a field
_MAX_CANCELLED_TERMS = 300  # a quotient with more terms is neither cancelled nor factored
_MAX_DEGREE = 300


Names = Callable[[], Mapping[str, flint.arb]]  # → balls for the names at one point


class UndecidedError(Exception):
    """The identity is out of reach: too large, or with functions that are not handled here."""


@dataclass(frozen=True)
class Algebraic:
    """Bounds on an algebraic number a.

    `degrees`: for the place of each unit in a, a bound on the unit's degree over older units;
    `divisor`: an integer d > 0 for which d·a is an algebraic integer; `house`: a bound on |a′| for
    every conjugate a′ of a.
    """

    degrees: Mapping[int, int]
    divisor: int
    house: flint.arb

    @property
    def degree(self) -> int:
        """A bound on the degree of the number."""
        return math.prod(self.degrees.values())


@dataclass(frozen=True)
class Unit:
    """One generator of the field.

    `ball` encloses its value at a point, at flint's present precision. `positive`: it is > 0
    wherever it is defined; `bounded`: it is between −1 and 1. `number`: the bounds on an algebraic
    number; None for functions.
    """

    index: int
    ball: Callable[["Point"], Ball]
    positive: bool = False
    bounded: bool = False
    number: Algebraic | None = None


class Point:
    """The balls of the units at one point; `names`: those of the names."""

    def __init__(self, field: "Field", names: Mapping[str, Ball]) -> None:
        self.field, self.names = field, names
        self.values: dict[int, Ball] = {}

    def enclose(self, x: Poly) -> Ball:
        """Return a ball that contains a polynomial in the units."""
        total = flint.arb(0)
        places = places_in(x)
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
        return self.enclose(x.above) / self.enclose(x.below)


class Field:
    """Quotients of polynomials in the names and in at most `room` more units."""

    def __init__(self, names: tuple[str, ...], room: int) -> None:
        self.ring = Polynomials(names, room)
        self.units: dict[int, Unit] = {}
        self.unit_by_key: dict[tuple[str, ...], Quotient] = {}
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
        """Add a unit under a key that is not yet in `unit_by_key`.

        `number`, for an algebraic number: its degree over older units, and the bounds with these
        units' degrees and the number's divisor and house.
        """
        try:
            index = self.ring.reserve_place()
        except OverflowError:
            raise UndecidedError("too many functions") from None
        bounds = number and replace(number[1], degrees={**number[1].degrees, index: number[0]})
        self.units[index] = Unit(index, ball, positive, bounded, bounds)
        self.unit_by_key[key] = self.polynomial(self.ring.gens[index])
        return self.unit_by_key[key]

    def relate(self, unit: "Quotient", power: int, relation: Poly) -> None:
        """Set relation = 0, a polynomial with this power of the unit, and older units; it replaces
        an earlier relation of the unit."""
        self.ring.relate(self.ring.gens[self.place(unit)], power, relation)

    def place(self, unit: "Quotient") -> int:
        """Return the place of a unit."""
        return places_in(unit.above)[0]

    def single(self, x: Poly) -> int | None:
        """Return the place of the unit that equals x; None if x is no unit."""
        places = places_in(x)
        alone = len(x) == 1 and len(places) == 1 and x.total_degree() == 1
        return places[0] if alone and x.leading_coefficient() == 1 else None

    # -- arithmetic ---------------------------------------------------------------------------

    def multiply(self, x: Poly, y: Poly) -> Poly:
        self.work += len(x) * len(y)
        # The work is counted over the whole life of the field, so that no identity takes long.
        if self.work > _MAX_WORK or x.total_degree() + y.total_degree() > 10 * _MAX_DEGREE:
            raise UndecidedError("too much work")
        return self.check_length(self.ring.reduce(x * y))

    def check_length(self, x: Poly) -> Poly:
        if len(x) > _MAX_TERMS:
            raise UndecidedError("too many terms")
        return x

    def divide(self, above: Poly, below: Poly) -> "Quotient":
        """Return the quotient; a common factor is cancelled if both are small."""
        if below.is_zero():
            raise UndecidedError("a division by zero")
        if above.is_zero():
            return self.zero
        if not below.is_constant() and self.is_small(above, below):
            common = above.gcd(below)
            if not common.is_constant():
                above, below = self.ring.reduce(above / common), self.ring.reduce(below / common)
        # Divisors have leading coefficient 1, so equal quotients have equal texts and keys.
        first = below.leading_coefficient()
        return Quotient(self, above / first, below / first)

    def is_small(self, *elements: Poly) -> bool:
        """Return True if the elements are small enough to be factored."""
        terms = sum(len(x) for x in elements)
        return terms <= _MAX_CANCELLED_TERMS and all(
            x.total_degree() <= _MAX_DEGREE for x in elements
        )

    def is_positive(self, place: int) -> bool:
        """Return True if the unit of that place is > 0 wherever it is defined."""
        return self.units[place].positive

    def is_bounded(self, place: int) -> bool:
        """Return True if the unit of that place is between −1 and 1."""
        return self.units[place].bounded

    def is_number(self, x: Poly) -> bool:
        """Return True if x contains algebraic numbers alone."""
        return all(self.units[place].number is not None for place in places_in(x))

    def terms(self, x: "Quotient") -> Iterator[tuple[Fraction, "Quotient"]]:
        """Yield (c, m) with x = Σ c·m, where c is rational and m a power product over x.below."""
        for monomial, c in terms_of(x.above):
            power_product = self.ring.context.from_dict({monomial: 1})
            yield Fraction(int(c.p), int(c.q)), self.divide(power_product, x.below)


@dataclass(frozen=True)
class Quotient:
    """The quotient above/below of polynomials in normal form."""

    field: Field
    above: Poly
    below: Poly

    @property
    def key(self) -> str:
        return f"{self.above}/{self.below}"

    @property
    def is_zero(self) -> bool:
        """True if the numerator is the zero polynomial; else the function may still be 0."""
        return bool(self.above.is_zero())

    @property
    def rational(self) -> flint.fmpq | None:
        """The quotient as a rational number; None unless both polynomials are constants."""
        if self.is_zero:
            return flint.fmpq(0)
        if self.above.is_constant() and self.below.is_constant():
            return self.above.leading_coefficient() / self.below.leading_coefficient()
        return None

    def __add__(self, other: "Quotient") -> "Quotient":
        f = self.field
        if self.below == other.below:
            return f.divide(f.ring.reduce(self.above + other.above), self.below)
        crossed = f.multiply(self.above, other.below) + f.multiply(other.above, self.below)
        return f.divide(crossed, f.multiply(self.below, other.below))

    def __neg__(self) -> "Quotient":
        return Quotient(self.field, -self.above, self.below)

    def __sub__(self, other: "Quotient") -> "Quotient":
        return self + -other

    def __mul__(self, other: "Quotient") -> "Quotient":
        f = self.field
        return f.divide(f.multiply(self.above, other.above), f.multiply(self.below, other.below))

    def __truediv__(self, other: "Quotient") -> "Quotient":
        return self * other.inverse()

    def inverse(self) -> "Quotient":
        return self.field.divide(self.below, self.above)

    def __pow__(self, n: int) -> "Quotient":
        if n < 0:
            return self.inverse() ** -n
        if n < 2:
            return self if n else self.field.one
        half = self ** (n // 2)
        return half * half * self if n % 2 else half * half

    def times(self, c: int | Fraction | flint.fmpq) -> "Quotient":
        """Return the product with a rational number."""
        if isinstance(c, Fraction):
            c = flint.fmpq(c.numerator, c.denominator)
        return Quotient(self.field, self.above * c, self.below) if c != 0 else self.field.zero
