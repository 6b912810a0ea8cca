"""The translation of a ring's element to a field of functions, in which hidden identities show."""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.identities.angles import Angles
from verify.algebra.identities.field import Field, Quotient, UndecidedError
from verify.algebra.identities.polynomials import Generator, Poly, terms_of
from verify.algebra.identities.powers import Divisors, FinerError, Powers
from verify.functions import in_rings

_MAX_GENERATORS = 40
_MAX_TERMS = 20_000
_ATTEMPTS = 12


class FieldImage:
    """One element of a ring, and the generators that it depends on, as quotients of a field.

    Its construction raises UndecidedError if the element is too large.
    """

    def __init__(
        self, generators: Sequence[Generator], x: Poly, finer: Divisors, *, tangents: bool
    ) -> None:
        self.used = generators
        if len(self.used) > _MAX_GENERATORS or len(x) > _MAX_TERMS:
            raise UndecidedError("too large")
        names = tuple(g.name for g in self.used if g.kind == "variable")
        self.field = Field(names, 2 * len(self.used) + 24)
        self.powers = Powers(self.field, finer)
        self.angles = Angles(self.field, self.powers, tangents=tangents)
        self.images: dict[int, Quotient] = {}
        self._cache: dict[tuple[str, int], Poly] = {}
        for g in self.used:
            self.images[g.index] = self._image(g)
        self.element = self.translate(x)

    def translate(self, x: Poly) -> Quotient:
        """Return the image of a polynomial in the ring's generators, over one common divisor."""
        field, degrees = self.field, x.degrees()
        generators = [g for g in self.used if degrees[g.index] > 0]
        below = {g.index: str(self.images[g.index].below) for g in generators}
        divisors = {below[g.index]: self.images[g.index].below for g in generators}
        divided = [
            {key: sum(int(m[k]) for k in below if below[k] == key) for key in divisors}
            for m in x.monoms()
        ]
        # The common divisor has each distinct divisor to its highest power in any term.
        most = {key: max(powers[key] for powers in divided) for key in divisors}
        power, total = self._powers_of, field.ring.zero
        for (monomial, c), powers in zip(terms_of(x), divided, strict=True):
            term = field.ring.context.constant(c)
            for g in generators:
                if n := int(monomial[g.index]):
                    term = field.multiply(term, power(self.images[g.index].above, n))
            for key, n in powers.items():
                if n < most[key]:
                    term = field.multiply(term, power(divisors[key], most[key] - n))
            total += term
            field.check_length(total)
        divisor = field.ring.one
        for key, n in most.items():
            divisor = field.multiply(divisor, power(divisors[key], n))
        return field.divide(field.ring.reduce(total), divisor)

    def _powers_of(self, x: Poly, n: int) -> Poly:
        key = str(x), n
        if key not in self._cache:
            self._cache[key] = x if n == 1 else self.field.multiply(self._powers_of(x, n - 1), x)
        return self._cache[key]

    def _image(self, g: Generator) -> Quotient:
        if g.kind == "variable":
            return self.field.polynomial(self.field.ring.gens[self.field.ring.places[g.name]])
        if g.kind == "pi":
            return self.angles.pi
        u = self.translate(g.inner)
        match g.kind:
            case "root":
                return self.root(u, g.degree)
            case "inverse":
                return u.inverse()
        image = in_rings()[g.kind].image
        assert image is not None  # noqa: S101 - a ring has no other functions
        quotient: Quotient = image(self, u)
        return quotient

    # -- the images of functions (see `verify.functions`) ---------------------------------------

    def half_sum(self, u: Quotient, sign: int) -> Quotient:
        """Return (e^u + sign·e^−u)/2."""
        up = self.powers.exponential(u)
        return (up + up.inverse().times(sign)).times(Fraction(1, 2))

    def root(self, u: Quotient, degree: int) -> Quotient:
        """Return the root of u; u > 0 is assumed, since the root is defined."""
        self.powers.assume_positive(u)
        return self.powers.power(u, Fraction(1, degree))

    def logarithm(self, u: Quotient) -> Quotient:
        """Return log u; u > 0 is assumed, since the logarithm is defined."""
        self.powers.assume_positive(u)
        return self.powers.logarithm(u)


def translate_element(generators: Sequence[Generator], x: Poly, *, tangents: bool) -> FieldImage:
    """Return the image of x; units are divided as finely as necessary.

    `generators`: all generators that x depends on, the oldest first.
    """
    # Each FinerError has recorded a finer divisor in `finer`, with which the field is built again.
    finer = Divisors()
    for _ in range(_ATTEMPTS):
        try:
            return FieldImage(generators, x, finer, tangents=tangents)
        except FinerError:
            continue
    raise UndecidedError("units are divided more and more finely")
