"""Polynomials over the rationals, modulo relations, each of which replaces a generator's power."""

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
        """The argument of a function, a root or an inverse; a variable and π have none."""
        assert self.argument is not None  # noqa: S101 - the caller checks the kind
        return self.argument


def terms_of(x: Poly) -> Iterator[tuple[tuple[int, ...], flint.fmpq]]:
    """Iterate over the monomials, as powers of all generators, with their coefficients.

    That is far faster than flint's own dictionary.
    """
    return zip(x.monoms(), x.coeffs(), strict=True)


def places_in(x: Poly) -> list[int]:
    """Return the places of the generators in x."""
    return [place for place, power in enumerate(x.degrees()) if power > 0]


def split(x: Poly, place: int) -> dict[int, Poly]:
    """Split x by the powers of the generator of that place: the coefficients that are not 0.

    They come from Taylor's theorem at 0, so that no term passes through Python.
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
    """Return the coefficient, by its terms, of each power product of generators at these places."""
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
        generator_names = [f"_{k}" for k in range(room)]  # no name begins so
        # Lexicographic with the newest generator first: relations then reduce to older ones.
        self.context = flint.fmpq_mpoly_ctx.get([*generator_names, *names], ordering)
        self.gens = self.context.gens()
        self.places = {name: room + k for k, name in enumerate(names)}
        self.zero, self.one = self.context.constant(0), self.context.constant(1)
        self.free = room  # generators from this place on are in use
        self.relations: list[tuple[int, int, Poly]] = []  # generator, its power, polynomial = 0

    def constant(self, value: Fraction) -> Poly:
        """Convert a rational number to an element."""
        return self.context.constant(flint.fmpq(value.numerator, value.denominator))

    def variable(self, name: str) -> Poly:
        """Return a variable as an element; KeyError if the ring has none of that name."""
        return self.gens[self.places[name]]

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """Return x y in normal form."""
        return self.reduce(x * y)

    def reserve_place(self) -> int:
        """Reserve the place of a new generator; OverflowError where there is no room."""
        if not self.free:
            raise OverflowError
        self.free -= 1
        return self.free

    def relate(self, generator: Poly, power: int, relation: Poly) -> None:
        """Set relation = 0, with a power of its newest generator; it replaces an older relation."""
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
