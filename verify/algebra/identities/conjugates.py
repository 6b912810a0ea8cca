"""Square roots of functions, by the product of all signs that they may have.

Where x is a polynomial in square roots ρ, the product of x with its conjugates, in which signs of
the ρ are changed, is a polynomial in the ρ². On a connected set a product of analytic functions is
0 only where one factor is: x is, if none of its conjugates is 0 at one point.
"""

from verify.algebra.identities.field import Field, Names, Point
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.polynomials import Poly, occurring, split
from verify.algebra.identities.translation import Translation
from verify.arithmetic.flint_precision import working_precision

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
