"""A ring element that is the zero function, and neither its normal form nor a point tells.

The element is translated to a field of functions in which more identities show:
- cosines and sines are expanded over parts of angles, rational multiples of π being split off, and
  hyperbolic functions are of exponentials;
- roots and logarithms are those of irreducible factors, as |·|^r and log |·| are homomorphisms;
- numbers are told from 0 by a bound from below (`identities.numbers`).
What is then not 0 yet may be by a relation between logarithms or between arctangents
(`identities.relations`), or between square roots. Every step is an identity of functions wherever
the element is defined; a zero that is defined nowhere is none.

Square roots of functions, by the product of all signs that they may have.

Where x is a polynomial in square roots ρ, the product of x with its conjugates, in which signs of
the ρ are changed, is a polynomial in the ρ². On a connected set a product of analytic functions is
0 only where one factor is: x is, if none of its conjugates is 0 at one point.
"""

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.identities.field import Field, Names, Point, UndecidedError
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.polynomials import Poly, occurring, split
from verify.algebra.identities.relations import without_related
from verify.algebra.identities.translation import Translation, translated
from verify.algebra.where_positive import is_convex, point_of
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings
from verify.functions.function import CIRCLE

_MOST_ROOTS = 4
_BITS = 256


def vanishes_by_conjugates(t: Translation, x: Poly, names: Names) -> bool:
    """Whether x, defined on a connected set with the point of `names`, is shown to be 0 there."""
    field = t.field
    # Tangents have poles, and signs jump: with them conjugates need not be analytic.
    if any(key[0] in ("tangent", "sign") for key in field.known):
        return False
    conjugates = [x]
    product = x
    while not product.is_zero():
        place = next((p for p in occurring(product) if _is_square_root(t, p)), None)
        if place is None or len(conjugates) > 2**_MOST_ROOTS:
            break
        conjugates += [_conjugate(field, y, place) for y in conjugates]
        product = field.multiplied(product, _conjugate(field, product, place))
    if len(conjugates) == 1 or not vanishes(field, product):
        return False
    with working_precision(_BITS):
        at = Point(field, names())
        return all(not at.of(y).contains(0) for y in conjugates[1:])


def _is_square_root(t: Translation, place: int) -> bool:
    return (
        place in t.powers.roots
        and t.powers.roots[place][1] == 2
        and t.field.units[place].number is None
    )


def _conjugate(field: Field, x: Poly, place: int) -> Poly:
    parts = split(x, place)
    unit = field.ring.gens[place]
    return sum((part * (-unit) ** n for n, part in parts.items()), field.ring.zero)


def is_hidden_zero(ring: DifferentialRing, x: Poly) -> bool:
    """True where x is shown to be 0 wherever it is defined; else False, which says nothing."""
    point = point_of(ring, x)
    if point is None:
        return False
    kinds = {g.kind for g in ring.generators_in(x)}
    functions = [in_rings()[kind] for kind in kinds & in_rings().keys()]
    waves = any(f.pair is CIRCLE for f in functions)
    # Tangents serve to find factors, which only roots and logarithms are asked for.
    factored = "root" in kinds or any(f.pair is None and not f.turns for f in functions)
    ways = (False, True) if waves and factored else (False,)
    return any(_is_shown(ring, x, point, tangents) for tangents in ways)


def _is_shown(ring: DifferentialRing, x: Poly, names: Names, tangents: bool) -> bool:
    try:
        return _vanishes(translated(ring.generators_in(x), x, tangents=tangents), ring, x, names)
    except UndecidedError:
        return False


def _vanishes(t: Translation, ring: DifferentialRing, x: Poly, names: Names) -> bool:
    above = t.element.above
    if vanishes(t.field, above):
        return True
    turning = [name for name, f in in_rings().items() if f.turns]
    angles = [g.inner for g in t.used if g.kind in turning]
    left = without_related(t, above, names, lambda: is_convex(ring, angles, inside=x))
    if left != above and vanishes(t.field, left):
        return True
    return is_convex(ring, [x], inside=x) and vanishes_by_conjugates(t, left, names)
