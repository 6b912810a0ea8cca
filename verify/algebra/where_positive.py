"""Where elements of a ring are positive, and where they are defined: a point, and whether convex.

Defined is an element where every divisor in it is not 0 and what its roots and logarithms are of is
positive. On a convex set (any connected one would do) an analytic function that is locally constant
is constant. The root of an even power of v is |v|, which is smooth where v has one sign.
"""

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import isqrt

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.enclosure import Enclosures, enclose, points
from verify.algebra.generator import Generator, Poly
from verify.algebra.identities.field import Names, UndecidedError
from verify.algebra.identities.signs import definite
from verify.algebra.identities.translation import translated
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings

_BITS = 128
_NEARBY = 10**6
_PRIMES = [n for n in range(2, 1000) if all(n % k for k in range(2, isqrt(n) + 1))]


def sign_everywhere(ring: DifferentialRing, x: Poly, *, strict: bool = False) -> int | None:
    """1 where x ≥ 0 wherever it is defined, −1 where x ≤ 0, None where neither is shown.

    `strict`: x ≠ 0 is shown, too.
    """
    found = definite(x, _Generators(ring, x), strict=strict)
    return found if found or ring.in_variables(x) else _sign_in_field(ring, x, strict=strict)


def _sign_in_field(ring: DifferentialRing, x: Poly, *, strict: bool) -> int | None:
    """By exponentials: with them cosh 5 q is positive; as a polynomial in cosh q it is not."""
    try:
        image = translated(ring.generators_in(x), x, tangents=False)
    except UndecidedError:
        return None
    above = definite(image.element.above, image.field, strict=strict)
    below = definite(image.element.below, image.field, strict=True)
    return above * below if above and below else None


class _Generators:
    """What is known of a ring's generators that are in an element."""

    def __init__(self, ring: DifferentialRing, x: Poly) -> None:
        self.ring = ring
        self.by_index = {g.index: g for g in ring.generators_in(x)}
        self.known: dict[int, bool] = {}

    def positive(self, place: int) -> bool:
        if place not in self.known:
            self.known[place] = self._is_positive(place)
        return self.known[place]

    def _is_positive(self, place: int) -> bool:
        g = self.by_index[place]
        where = _positive_where(g)
        if where is True:
            return True
        if where and sign_everywhere(self.ring, where(g.inner), strict=True) == 1:
            return True
        inside = self.ring.generators_in(self.ring.context.gens()[place])
        if any(other.kind == "variable" for other in inside):
            return False
        ball = enclose(self.ring, self.ring.context.gens()[place], {}, _BITS)
        return bool(ball is not None and ball > 0)

    def bounded(self, place: int) -> bool:
        function = in_rings().get(self.by_index[place].kind)
        return function is not None and function.bounded


def _positive_where(g: Generator) -> Callable[[Poly], Poly] | bool:
    """Whether it is positive everywhere, or what, made from its argument, is where it is."""
    if g.kind in ("pi", "root"):  # a root inside of where it is defined
        return True
    if g.kind == "inverse":
        return lambda u: u
    function = in_rings().get(g.kind)
    return function is not None and function.positive


def _inside(g: Generator) -> Poly | None:
    """What has to be positive for a root or a function as log to be defined; None of others."""
    if g.kind == "root":
        return g.inner
    function = in_rings().get(g.kind)
    return function.domain.inside(g.inner) if function and function.domain else None


def size_of_base(ring: DifferentialRing, u: Poly, power: int) -> tuple[flint.fmpq, Poly] | None:
    """|c| and |v| of u = c·v^power, a polynomial whose factors' multiplicities `power` divides.

    None where the sign of a factor that matters is not shown, or u is not positive.
    """
    c, factors = u.factor()
    size, sign = ring.one, 1 if c > 0 else -1
    for f, n in factors:
        own = sign_everywhere(ring, f) if int(n) // power % 2 else 1
        if own is None:
            return None
        size = ring.multiply(size, (f * own) ** (int(n) // power))
        sign *= own ** int(n)
    return (abs(c), size) if sign > 0 else None


def point_of(ring: DifferentialRing, x: Poly) -> Names | None:
    """A point around which x is defined and may be 0, if one is found; as balls for the names."""
    used = ring.generators_in(x)
    names = [g.name for g in used if g.kind == "variable"]
    positive = [inside for g in used if (inside := _inside(g)) is not None]
    enclosures = Enclosures(ring, [x, *positive])
    for point in points(names):
        near = _near(point)
        with working_precision(_BITS):
            balls = enclosures.over(near())
        if balls is not None and all(ball > 0 for ball in balls[1:]):
            return near if balls[0].contains(0) else None
    return None


def _near(point: Mapping[str, Fraction]) -> Names:
    """A point very near to a rational one, but with no relation between its numbers by accident."""

    def balls() -> Mapping[str, flint.arb]:
        return {
            name: flint.fmpq(at.numerator, at.denominator)
            * (1 + flint.arb(_PRIMES[k % len(_PRIMES)]).sqrt() / _NEARBY)
            for k, (name, at) in enumerate(sorted(point.items()))
        }

    return balls


def is_convex(ring: DifferentialRing, elements: Iterable[Poly], inside: Poly) -> bool:
    """Whether the part of space where the elements are defined, and `inside` may be, is convex.

    Shown only where what must not vanish has no zero, or is bounded by planes of which it is known
    on which side `inside` is defined.
    """
    half_spaces = _half_spaces(ring, ring.generators_in(inside))
    for g in ring.generators_in(*elements):
        shaped = g.inner if g.kind == "inverse" else _inside(g)
        for f, _ in _factors(shaped) if shaped is not None else ():
            shown = sign_everywhere(ring, f, strict=True)
            if shown is None and f not in half_spaces:
                return False
    return True


def _half_spaces(ring: DifferentialRing, used: list[Generator]) -> list[Poly]:
    """Polynomials of degree 1 in the variables that have one sign wherever all is defined."""
    found: list[Poly] = []
    for g in used:
        if (inside := _inside(g)) is not None:
            signed = [f for f, n in _factors(inside) if n % 2 and sign_everywhere(ring, f) is None]
            if len(signed) == 1 and signed[0].total_degree() == 1 and ring.in_variables(signed[0]):
                found += signed
    return found


def _factors(x: Poly) -> list[tuple[Poly, int]]:
    return [(f, int(n)) for f, n in x.factor()[1]]
