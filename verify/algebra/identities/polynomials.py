"""Polynomials over the rationals modulo relations; a relation replaces a power of a generator."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

Poly = flint.fmpq_mpoly
Monomial = tuple[int, ...]  # the exponents of all generators


@dataclass(frozen=True)
class Generator:
    """One generator of a ring: a kind of function, and its argument.

    `kind`: `variable` (with a `name`), `pi`, a function of `verify.functions.in_rings`, `root`
    (with a `degree`), or `inverse`. `index`: its place.
    """

    index: int
    kind: str
    argument: Poly | None = None
    degree: int = 1
    name: str = ""

    @property
    def inner(self) -> Poly:
        """The argument; a variable and π have none."""
        assert self.argument is not None  # noqa: S101 - the caller checks the kind
        return self.argument


def terms_of(x: Poly) -> Iterator[tuple[tuple[int, ...], flint.fmpq]]:
    """Return an iterator over (exponents of all generators, coefficient) of the terms.

    It is far faster than flint's dictionary.
    """
    return zip(x.monoms(), x.coeffs(), strict=True)


def places_in(x: Poly) -> list[int]:
    """Return the places of the generators in x."""
    return [place for place, power in enumerate(x.degrees()) if power > 0]


def split(x: Poly, place: int) -> dict[int, Poly]:
    """Return {power: coefficient ≠ 0} of x as a polynomial in the generator of that place.

    The coefficients are those of Taylor's formula at 0, so that no term passes through Python.
    """
    parts = {}
    # The n-th derivative at 0, divided by n!, is the coefficient of the n-th power.
    for power in range(x.degrees()[place] + 1):
        part = x.subs({place: 0})
        if not part.is_zero():
            parts[power] = part / math.factorial(power)
        x = x.derivative(place)
    return parts


def split_by_monomials(
    x: Poly, places: Collection[int]
) -> dict[Monomial, dict[Monomial, flint.fmpq]]:
    """Return {power product of the generators at `places`: terms of its coefficient in x}."""
    coefficients: dict[Monomial, dict[Monomial, flint.fmpq]] = {}
    for monomial, c in terms_of(x):
        inside = tuple(n if place in places else 0 for place, n in enumerate(monomial))
        outside = tuple(0 if place in places else n for place, n in enumerate(monomial))
        coefficients.setdefault(inside, {})[outside] = c
    return coefficients


class Polynomials:
    """The polynomials in some names and in up to `room` generators, which are added one by one."""

    def __init__(
        self, names: Sequence[str], room: int = 0, ordering: flint.Ordering = flint.Ordering.lex
    ) -> None:
        generator_names = [f"_{k}" for k in range(room)]  # no other name begins with _
        # The lexicographic order has the newest generator first: relations reduce to older ones.
        self.context = flint.fmpq_mpoly_ctx.get([*generator_names, *names], ordering)
        self.gens = self.context.gens()
        self.places = {name: room + k for k, name in enumerate(names)}
        self.zero, self.one = self.context.constant(0), self.context.constant(1)
        self.free = room  # generators from this place on are in use
        self.relations: list[tuple[int, int, Poly]] = []  # (place, power, polynomial = 0)

    def constant(self, value: Fraction) -> Poly:
        """Convert a rational number to an element."""
        return self.context.constant(flint.fmpq(value.numerator, value.denominator))

    def variable(self, name: str) -> Poly:
        """Return a variable as an element. Raises KeyError if there is none of that name."""
        return self.gens[self.places[name]]

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """Return x y in normal form."""
        return self.reduce(x * y)

    def reserve_place(self) -> int:
        """Return the place of a new generator. Raises OverflowError if there is no room."""
        if not self.free:
            raise OverflowError
        self.free -= 1
        return self.free

    def relate(self, generator: Poly, power: int, relation: Poly) -> None:
        """Set relation = 0, whose leading term is this power of `generator`, its newest one; it
        replaces an earlier relation of the generator."""
        place = self.gens.index(generator)
        older = (each for each in self.relations if each[0] != place)
        self.relations = sorted([*older, (place, power, relation)], key=lambda each: -each[0])

    def reduce(self, x: Poly) -> Poly:
        """Reduce x to its normal form modulo the relations, newest generator first."""
        if self.relations:
            degrees = x.degrees()
            for place, power, relation in reversed(self.relations):
                if degrees[place] >= power:
                    x = divmod(x, relation)[1]
                    degrees = x.degrees()
        return x
