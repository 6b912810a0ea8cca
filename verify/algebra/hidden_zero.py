"""The proof that a ring element is the zero function where its normal form does not show it.

The element is translated to a field of functions in which more identities show:
- cosines and sines are expanded over parts of angles, rational multiples of π being split off, and
  hyperbolic functions are of exponentials;
- roots and logarithms are those of irreducible factors, as |·|^r and log |·| are homomorphisms;
- numbers are distinguished from 0 by a bound from below (`identities.numbers`).
An element that is then still not 0 may be shown to be 0 by a relation between logarithms or between
arctangents (`identities.relations`), or between square roots. Every step is an identity of
functions wherever the element is defined; an element that is defined nowhere is not called zero.

Square roots of functions are treated by the product over all their signs.

Where x is a polynomial in square roots ρ, the product of x with its conjugates, in which signs of
the ρ are changed, is a polynomial in the ρ². On a connected set a product of analytic functions is
0 only where one factor is: x is, if none of its conjugates is 0 at one point.
"""

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.identities.field import Field, Names, Point, UndecidedError
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.polynomials import Poly, places_in, split
from verify.algebra.identities.relations import eliminate_related
from verify.algebra.identities.translation import Translation, translate_element
from verify.algebra.where_positive import is_convex, point_of
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings
from verify.functions.function import CIRCLE

_MOST_ROOTS = 4
_BITS = 256


def vanishes_by_conjugates(t: Translation, x: Poly, names: Names) -> bool:
    """Return True if x is shown to be 0 on a connected set with the point of `names`."""
    field = t.field
    # Tangents have poles, and signs jump: with them conjugates need not be analytic.
    if any(key[0] in ("tangent", "sign") for key in field.unit_by_key):
        return False
    conjugates = [x]
    product = x
    while not product.is_zero():
        place = next((p for p in places_in(product) if _is_square_root(t, p)), None)
        if place is None or len(conjugates) > 2**_MOST_ROOTS:
            break
        conjugates += [_conjugate(field, y, place) for y in conjugates]
        product = field.multiply(product, _conjugate(field, product, place))
    if len(conjugates) == 1 or not vanishes(field, product):
        return False
    with working_precision(_BITS):
        point = Point(field, names())
        return all(not point.enclose(y).contains(0) for y in conjugates[1:])


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
    """Return True if x is shown to be 0 wherever it is defined; False decides nothing."""
    point = point_of(ring, x)
    if point is None:
        return False
    kinds = {g.kind for g in ring.generators_in(x)}
    functions = [in_rings()[kind] for kind in kinds & in_rings().keys()]
    waves = any(f.pair is CIRCLE for f in functions)
    # Half-angle tangents serve to find factors, which only roots and logarithms need.
    factored = "root" in kinds or any(f.pair is None and not f.turns for f in functions)
    # The form without tangents is tried first, as it adds no denominators.
    ways = (False, True) if waves and factored else (False,)
    return any(_is_shown(ring, x, point, tangents) for tangents in ways)


def _is_shown(ring: DifferentialRing, x: Poly, names: Names, tangents: bool) -> bool:
    try:
        return _vanishes(
            translate_element(ring.generators_in(x), x, tangents=tangents), ring, x, names
        )
    except UndecidedError:
        return False


def _vanishes(t: Translation, ring: DifferentialRing, x: Poly, names: Names) -> bool:
    above = t.element.above
    if vanishes(t.field, above):
        return True
    turning = [name for name, f in in_rings().items() if f.turns]
    angles = [g.inner for g in t.used if g.kind in turning]
    remaining = eliminate_related(t, above, names, lambda: is_convex(ring, angles, inside=x))
    if remaining != above and vanishes(t.field, remaining):
        return True
    return is_convex(ring, [x], inside=x) and vanishes_by_conjugates(t, remaining, names)
