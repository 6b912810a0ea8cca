"""Polynomials over the rationals, modulo relations that each give a power of one generator."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

Poly = flint.fmpq_mpoly
Monomial = tuple[int, ...]  # the powers of all generators


@dataclass(frozen=True)
class Generator:
    """One ring generator: `kind` of function, and its argument.

    `kind`: variable, which has a `name`, pi, a function of `verify.functions.in_rings`, root (of
    `degree`), or inverse.
    """

    index: int
    kind: str
    argument: Poly | None = None
    degree: int = 1
    name: str = ""

    @property
    def inner(self) -> Poly:
        """The argument; of a function, a root, an inverse: not of a variable or π."""
        assert self.argument is not None  # noqa: S101 - the caller looks at the kind
        return self.argument


def terms_of(x: Poly) -> Iterator[tuple[tuple[int, ...], flint.fmpq]]:
    """Each monomial, as the powers of all generators, with its coefficient.

    Far faster than by a dictionary of flint's own making.
    """
    return zip(x.monoms(), x.coeffs(), strict=True)


def occurring(x: Poly) -> list[int]:
    """The places of the generators that are in x."""
    return [place for place, power in enumerate(x.degrees()) if power > 0]


def split(x: Poly, at: int) -> dict[int, Poly]:
    """x as a polynomial in the generator of that place: its coefficients that are not 0.

    By Taylor's theorem at 0, so that no term passes through Python.
    """
    found = {}
    for power in range(x.degrees()[at] + 1):
        part = x.subs({at: 0})
        if not part.is_zero():
            found[power] = part / math.factorial(power)
        x = x.derivative(at)
    return found


def by_monomials(x: Poly, places: Collection[int]) -> dict[Monomial, dict[Monomial, flint.fmpq]]:
    """The coefficient, by its terms, of each power product of the generators in these places."""
    found: dict[Monomial, dict[Monomial, flint.fmpq]] = {}
    for monomial, c in terms_of(x):
        inside = tuple(n if place in places else 0 for place, n in enumerate(monomial))
        rest = tuple(0 if place in places else n for place, n in enumerate(monomial))
        found.setdefault(inside, {})[rest] = c
    return found


class Polynomials:
    """Those in the given names and in up to `room` generators, which are made one by one."""

    def __init__(
        self, names: Sequence[str], room: int = 0, ordering: flint.Ordering = flint.Ordering.lex
    ) -> None:
        own = [f"_{k}" for k in range(room)]  # no name begins so
        # Lexicographic with the newest generator first: relations then reduce to older ones.
        self.context = flint.fmpq_mpoly_ctx.get([*own, *names], ordering)
        self.gens = self.context.gens()
        self.places = {name: room + k for k, name in enumerate(names)}
        self.zero, self.one = self.context.constant(0), self.context.constant(1)
        self.free = room  # generators from this place on are in use
        self.relations: list[tuple[int, int, Poly]] = []  # generator, its power, polynomial = 0

    def constant(self, value: Fraction) -> Poly:
        """A rational number as an element."""
        return self.context.constant(flint.fmpq(value.numerator, value.denominator))

    def variable(self, name: str) -> Poly:
        """A variable as an element; KeyError where the ring has none of that name."""
        return self.gens[self.places[name]]

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """x y in normal form."""
        return self.reduce(x * y)

    def made(self) -> int:
        """The place of a new generator; OverflowError where there is no room."""
        if not self.free:
            raise OverflowError
        self.free -= 1
        return self.free

    def relate(self, generator: Poly, power: int, relation: Poly) -> None:
        """relation = 0, with that power of its newest generator; instead of an older relation."""
        place = self.gens.index(generator)
        others = (each for each in self.relations if each[0] != place)
        self.relations = sorted([*others, (place, power, relation)], key=lambda each: -each[0])

    def reduce(self, x: Poly) -> Poly:
        """The normal form of x modulo the relations, newest generator first."""
        if self.relations:
            degrees = x.degrees()
            for place, power, relation in reversed(self.relations):
                if degrees[place] >= power:
                    x = divmod(x, relation)[1]
                    degrees = x.degrees()
        return x
