"""The proof that a ring element is the zero function although its normal form is not 0.

The element is translated to a field of functions in which more identities are visible:

- cosines and sines are expanded over parts of angles, after rational multiples of π are split off;
  hyperbolic functions become exponentials;
- roots and logarithms become those of irreducible factors, as |·|^r and log |·| are homomorphisms;
- numbers are distinguished from 0 by a lower bound (`identities.algebraic_numbers`).

If the element is still not 0, a relation between logarithms, between arctangents or between square
roots may show that it is. Every step is an identity of functions wherever the element is defined;
an element that is defined nowhere is not called zero.

Relations with integer coefficients are found numerically, by the LLL algorithm at one point, and
then proved exactly. Σ kᵢ log |fᵢ| = 0 if Π fᵢ^(2kᵢ) = 1. Σ kᵢ atan uᵢ is a multiple of π if
Π (1 + i uᵢ)^kᵢ is real; it is the same multiple everywhere on a convex set, and a ball at one point
determines it.

Let x be a polynomial in square roots ρ. Its product with its conjugates, in which signs of the ρ
are changed, is a polynomial in the ρ². On a connected set a product of analytic functions is 0 only
if one factor is: so x is, if no conjugate is 0 at one point.
"""

from collections.abc import Callable, Iterator

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.identities.algebraic_numbers import vanishes
from verify.algebra.identities.angles import power, times
from verify.algebra.identities.field import Field, Names, Point, Quotient, UndecidedError
from verify.algebra.identities.field_image import FieldImage, translate_element
from verify.algebra.identities.polynomials import Poly, places_in, split
from verify.algebra.positivity import is_convex, point_of
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings
from verify.functions.function import CIRCLE

_MAX_UNITS = 12
_BITS_PER_UNIT = 32
_MAX_MULTIPLE = 64  # in relations of functions, whose powers are computed
_MAX_MULTIPLE_OF_NUMBERS = 4096
_ANGLE_BITS = 128
_MAX_ROOTS = 4
_CONJUGATE_BITS = 256

Multiples = dict[int, int]  # place of a unit → its multiple ≠ 0 in a relation


def is_hidden_zero(ring: DifferentialRing, x: Poly) -> bool:
    """Return True if x is shown to be 0 wherever it is defined; False decides nothing."""
    point = point_of(ring, x)
    if point is None:
        return False
    kinds = {g.kind for g in ring.generators_in(x)}
    functions = [in_rings()[kind] for kind in kinds & in_rings().keys()]
    waves = any(f.pair is CIRCLE for f in functions)
    # With half-angle tangents more polynomials factor, which only roots and logarithms need.
    factored = "root" in kinds or any(f.pair is None and not f.turns for f in functions)
    # The form without tangents is tried first, since it adds no denominators.
    options = (False, True) if waves and factored else (False,)
    return any(_is_shown(ring, x, point, tangents) for tangents in options)


def _is_shown(ring: DifferentialRing, x: Poly, names: Names, tangents: bool) -> bool:
    try:
        return _vanishes(
            translate_element(ring.generators_in(x), x, tangents=tangents), ring, x, names
        )
    except UndecidedError:
        return False


def _vanishes(t: FieldImage, ring: DifferentialRing, x: Poly, names: Names) -> bool:
    above = t.element.above
    if vanishes(t.field, above):
        return True
    turning = [name for name, f in in_rings().items() if f.turns]
    angles = [g.inner for g in t.used if g.kind in turning]
    remaining = eliminate_related(t, above, names, lambda: is_convex(ring, angles, inside=x))
    if remaining != above and vanishes(t.field, remaining):
        return True
    return is_convex(ring, [x], inside=x) and vanishes_by_conjugates(t, remaining, names)


# -- relations between logarithms, and between arctangents ----------------------------------------


def eliminate_related(t: FieldImage, x: Poly, names: Names, convex: Callable[[], bool]) -> Poly:
    """Return x without those logarithms and arctangents that are rational combinations of others.

    `names()` returns balls for the names, at flint's precision, at a point where x is defined.
    `convex()` returns True if the arguments of the arctangents in x are defined on a convex set.
    """
    logarithms = [place for place in places_in(x) if place in t.powers.logarithms]
    x = _eliminate(t.field, x, logarithms, names, lambda k: _is_sum_of_logarithms(t, k))
    angles = [place for place in places_in(x) if place in t.angles.arctangents]
    constant = [place for place in angles if _is_number(t.angles.arctangents[place])]
    angles = angles if angles == constant or convex() else constant
    if not angles:
        return x
    # π stands last, so that it is never the unit that is replaced.
    angles.append(t.field.place(t.angles.pi))
    return _eliminate(t.field, x, angles, names, lambda k: _is_sum_of_angles(t, k, names))


def _is_number(u: Quotient) -> bool:
    return u.field.is_number(u.above) and u.field.is_number(u.below)


def _eliminate(
    field: Field, x: Poly, places: list[int], names: Names, is_relation: Callable[[Multiples], bool]
) -> Poly:
    remaining = list(places)
    # Each relation eliminates one unit, so the search is repeated with the others.
    while 1 < len(remaining) <= _MAX_UNITS:
        multiples = next((k for k in _candidates(field, remaining, names) if is_relation(k)), None)
        if multiples is None:
            break
        replaced = next(place for place in remaining if place in multiples)
        x = _replace_unit(field, x, multiples, replaced)
        remaining.remove(replaced)
    return x


def _candidates(field: Field, places: list[int], names: Names) -> Iterator[Multiples]:
    """Yield small integer multiples of units whose sum seems to be 0 at the point."""
    bits = _BITS_PER_UNIT * (len(places) + 1)
    with working_precision(2 * bits):
        point = Point(field, names())
        balls = [point.unit(place) * flint.arb(2) ** bits for place in places]
        if not all(ball.is_finite() and abs(ball) < flint.arb(2) ** (2 * bits) for ball in balls):
            return
        wholes = [int(ball.mid().floor().unique_fmpz() or 0) for ball in balls]
    # The rows (e_i, 2^bits·ball_i) span a lattice; a short vector of it is a relation with small
    # coefficients. LLL finds such vectors, and the caller proves the relation.
    rows = [[*(int(i == j) for j in range(len(places))), w] for i, w in enumerate(wholes)]
    for row in flint.fmpz_mat(rows).lll().tolist():
        multiples = [int(k) for k in row[:-1]]
        size = sum(map(abs, multiples))
        if size <= _MAX_MULTIPLE_OF_NUMBERS and abs(int(row[-1])) <= 2 * size:
            yield {place: k for place, k in zip(places, multiples, strict=True) if k}


def _replace_unit(field: Field, x: Poly, multiples: Multiples, place: int) -> Poly:
    """Return x with the unit of that place replaced by the other units of the relation."""
    gens, value, total = field.ring.gens, field.ring.zero, field.ring.zero
    for other, k in multiples.items():
        if other != place:
            value += gens[other] * flint.fmpq(-k, multiples[place])
    for n, part in split(x, place).items():
        total += field.multiply(part, value**n)
    return field.ring.reduce(total)


def _is_sum_of_logarithms(t: FieldImage, multiples: Multiples) -> bool:
    field, product = t.field, t.field.one
    try:
        for place, k in multiples.items():
            f = t.powers.logarithms[place]
            _check_multiple(k, number=field.is_number(f))
            product = product * field.polynomial(f) ** (2 * k)
        return vanishes(field, product.above - product.below)
    except UndecidedError:
        return False


def _is_sum_of_angles(t: FieldImage, multiples: Multiples, names: Names) -> bool:
    field, product = t.field, (t.field.one, t.field.zero)
    try:
        for place, k in multiples.items():
            if place in t.angles.arctangents:  # else it is π
                u = t.angles.arctangents[place]
                _check_multiple(k, number=_is_number(u))
                turned = power((field.one, u if k > 0 else -u), abs(k))
                product = times(product, turned)
        if not vanishes(field, product[1].above):
            return False
    except UndecidedError:
        return False
    with working_precision(_ANGLE_BITS):
        point = Point(field, names())
        total = sum((point.unit(place) * k for place, k in multiples.items()), flint.arb(0))
        return bool(abs(total) < 1)  # a multiple of π below 1 in size is 0


def _check_multiple(k: int, *, number: bool) -> None:
    if abs(k) > (_MAX_MULTIPLE_OF_NUMBERS if number else _MAX_MULTIPLE):
        raise UndecidedError("too high a power")


# -- square roots ---------------------------------------------------------------------------------


def vanishes_by_conjugates(t: FieldImage, x: Poly, names: Names) -> bool:
    """Return True if x is shown to be 0 on a connected set that contains the point of `names`."""
    field = t.field
    # Tangents have poles, and signs jump: conjugates with them need not be analytic.
    if any(key[0] in ("tangent", "sign") for key in field.unit_by_key):
        return False
    conjugates = [x]
    product = x
    while not product.is_zero():
        place = next((p for p in places_in(product) if _is_square_root(t, p)), None)
        if place is None or len(conjugates) > 2**_MAX_ROOTS:
            break
        conjugates += [_conjugate(field, y, place) for y in conjugates]
        product = field.multiply(product, _conjugate(field, product, place))
    if len(conjugates) == 1 or not vanishes(field, product):
        return False
    with working_precision(_CONJUGATE_BITS):
        point = Point(field, names())
        return all(not point.enclose(y).contains(0) for y in conjugates[1:])


def _is_square_root(t: FieldImage, place: int) -> bool:
    return (
        place in t.powers.roots
        and t.powers.roots[place][1] == 2
        and t.field.units[place].number is None
    )


def _conjugate(field: Field, x: Poly, place: int) -> Poly:
    parts = split(x, place)
    unit = field.ring.gens[place]
    return sum((part * (-unit) ** n for n, part in parts.items()), field.ring.zero)
