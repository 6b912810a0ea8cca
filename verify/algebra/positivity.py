"""The positivity of ring elements, and their domains: points in them, and convexity.

An element is defined where no divisor in it is 0 and the arguments of its roots and logarithms are
positive. On a convex set (any connected one would do) an analytic function that is locally constant
is constant. The root of an even power of v is |v|, which is smooth if v has one sign.
"""

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import isqrt

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.enclosure import Enclosures, enclose, points
from verify.algebra.identities.field import Names, UndecidedError
from verify.algebra.identities.field_image import translate_element
from verify.algebra.identities.polynomials import Generator, Poly
from verify.algebra.identities.signs import definite_sign
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings

_BITS = 128
_PERTURBATION_DIVISOR = 10**6  # a coordinate x is moved by x·√prime over this
_PRIMES = [n for n in range(2, 1000) if all(n % k for k in range(2, isqrt(n) + 1))]


def sign_everywhere(ring: DifferentialRing, x: Poly, *, strict: bool = False) -> int | None:
    """Return 1 if x ≥ 0 wherever it is defined, −1 if x ≤ 0 there, None if neither is shown.

    `strict`: 1 if x > 0, −1 if x < 0.
    """
    sign = definite_sign(x, _RingGenerators(ring, x), strict=strict)
    return sign if sign or ring.in_variables(x) else _sign_in_field(ring, x, strict=strict)


def _sign_in_field(ring: DifferentialRing, x: Poly, *, strict: bool) -> int | None:
    """Return the sign if it is visible in terms of exponentials.

    In them cosh 5 q is a positive sum; the sign of cosh 5 q as a polynomial in cosh q is not
    visible.
    """
    try:
        image = translate_element(ring.generators_in(x), x, tangents=False)
    except UndecidedError:
        return None
    above = definite_sign(image.element.above, image.field, strict=strict)
    below = definite_sign(image.element.below, image.field, strict=True)
    return above * below if above and below else None


class _RingGenerators:
    """Facts about the generators in an element of a ring (see `identities.signs.Facts`)."""

    def __init__(self, ring: DifferentialRing, x: Poly) -> None:
        self.ring = ring
        self.by_index = {g.index: g for g in ring.generators_in(x)}
        self.cache: dict[int, bool] = {}

    def is_positive(self, place: int) -> bool:
        if place not in self.cache:
            self.cache[place] = self._decide_positive(place)
        return self.cache[place]

    def _decide_positive(self, place: int) -> bool:
        g = self.by_index[place]
        condition = _positive_where(g)
        if condition is True:
            return True
        if condition and sign_everywhere(self.ring, condition(g.inner), strict=True) == 1:
            return True
        inside = self.ring.generators_in(self.ring.context.gens()[place])
        if any(generator.kind == "variable" for generator in inside):
            return False
        # A generator without variables is a number, whose sign a ball decides.
        ball = enclose(self.ring, self.ring.context.gens()[place], {}, _BITS)
        return bool(ball is not None and ball > 0)

    def is_bounded(self, place: int) -> bool:
        function = in_rings().get(self.by_index[place].kind)
        return function is not None and function.bounded


def _positive_where(g: Generator) -> Callable[[Poly], Poly] | bool:
    """Return True if the generator is positive wherever it is defined, False if it is not known to
    be; or a function of its argument that is positive if and only if the generator is."""
    if g.kind in ("pi", "root"):  # a root is 0 at most at the boundary of its domain
        return True
    if g.kind == "inverse":
        return lambda u: u
    function = in_rings().get(g.kind)
    return function is not None and function.positive


def _inside(g: Generator) -> Poly | None:
    """Return the element that must be positive for a root or a logarithm to be defined; None for
    other generators."""
    if g.kind == "root":
        return g.inner
    function = in_rings().get(g.kind)
    return function.domain.inside(g.inner) if function and function.domain else None


def size_of_base(ring: DifferentialRing, u: Poly, power: int) -> tuple[flint.fmpq, Poly] | None:
    """Return |c| and |v| for u = c·v^power; None if the sign of a factor that matters is not shown,
    or u is not positive. `power` divides the multiplicities of u's factors."""
    c, factors = u.factor()
    size, sign = ring.one, 1 if c > 0 else -1
    for f, n in factors:
        sign_of_factor = sign_everywhere(ring, f) if int(n) // power % 2 else 1
        if sign_of_factor is None:
            return None
        # A factor with an even power in |v| needs no sign; one with an odd power must have one.
        size = ring.multiply(size, (f * sign_of_factor) ** (int(n) // power))
        sign *= sign_of_factor ** int(n)
    return (abs(c), size) if sign > 0 else None


def point_of(ring: DifferentialRing, x: Poly) -> Names | None:
    """Return a point at which x is defined and may be 0, as a function that returns balls for the
    names; None if x is not 0 at the first point where it is defined, or no such point is found."""
    generators = ring.generators_in(x)
    names = [g.name for g in generators if g.kind == "variable"]
    positive = [inside for g in generators if (inside := _inside(g)) is not None]
    enclosures = Enclosures(ring, [x, *positive])
    for point in points(names):
        perturbed = _perturb(point)
        with working_precision(_BITS):
            balls = enclosures.enclose_over(perturbed())
        if balls is not None and all(ball > 0 for ball in balls[1:]):
            return perturbed if balls[0].contains(0) else None
    return None


def _perturb(point: Mapping[str, Fraction]) -> Names:
    """Return a point near a rational one whose coordinates satisfy no relation by accident."""

    def balls() -> Mapping[str, flint.arb]:
        return {
            # Square roots of distinct primes are linearly independent over the rationals.
            name: flint.fmpq(value.numerator, value.denominator)
            * (1 + flint.arb(_PRIMES[k % len(_PRIMES)]).sqrt() / _PERTURBATION_DIVISOR)
            for k, (name, value) in enumerate(sorted(point.items()))
        }

    return balls


def is_convex(ring: DifferentialRing, elements: Iterable[Poly], inside: Poly) -> bool:
    """Return True if the elements' domain within the domain of `inside` is shown to be convex.

    It is if the divisors have no zeros, or if their zeros are planes and the domain of `inside`
    lies on one side of each.
    """
    half_spaces = _half_spaces(ring, ring.generators_in(inside))
    for g in ring.generators_in(*elements):
        nonzero = g.inner if g.kind == "inverse" else _inside(g)
        for f, _ in _factors(nonzero) if nonzero is not None else ():
            sign = sign_everywhere(ring, f, strict=True)
            if sign is None and f not in half_spaces:
                return False
    return True


def _half_spaces(ring: DifferentialRing, generators: list[Generator]) -> list[Poly]:
    """Return polynomials of degree 1 that have one sign wherever all generators are defined."""
    half_spaces: list[Poly] = []
    for g in generators:
        if (inside := _inside(g)) is not None:
            signed = [f for f, n in _factors(inside) if n % 2 and sign_everywhere(ring, f) is None]
            if len(signed) == 1 and signed[0].total_degree() == 1 and ring.in_variables(signed[0]):
                half_spaces += signed
    return half_spaces


def _factors(x: Poly) -> list[tuple[Poly, int]]:
    return [(f, int(n)) for f, n in x.factor()[1]]
