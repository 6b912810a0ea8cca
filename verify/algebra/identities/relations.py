"""Relations with whole coefficients between logarithms, and between arctangents and π.

They are found numerically, by the LLL algorithm at one point, and then proved exactly:
Σ kᵢ log |fᵢ| = 0 where Π fᵢ^(2kᵢ) = 1; and Σ kᵢ atan uᵢ is a multiple of π where Π (1 + i uᵢ)^kᵢ is
real, the same multiple everywhere on a convex set, so that a ball at one point determines it.
"""

from collections.abc import Callable, Iterator

import flint

from verify.algebra.identities.angles import power, times
from verify.algebra.identities.field import Field, Names, Point, Quotient, UndecidedError
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.polynomials import Poly, places_in, split
from verify.algebra.identities.translation import Translation
from verify.arithmetic.flint_precision import working_precision

_MOST_UNITS = 12
_BITS_EACH = 32
_LARGEST = 64  # multiple, where powers of a function are to be made
_LARGEST_OF_NUMBERS = 4096
_BITS_OF_ANGLE = 128

Multiples = dict[int, int]  # of units, by their places; none is 0


def eliminate_related(t: Translation, x: Poly, names: Names, convex: Callable[[], bool]) -> Poly:
    """Replace logarithms and arctangents in x that are rational combinations of others.

    `names`: returns balls for the names, in flint's precision, at a point where x is defined.
    `convex`: returns True if the arguments of the arctangents in x are defined on a convex set.
    """
    logarithms = [place for place in places_in(x) if place in t.powers.logarithms]
    x = _eliminate(t.field, x, logarithms, names, lambda k: _is_sum_of_logarithms(t, k))
    angles = [place for place in places_in(x) if place in t.angles.arctangents]
    constant = [place for place in angles if _is_number(t.angles.arctangents[place])]
    angles = angles if angles == constant or convex() else constant
    if not angles:
        return x
    # π is the oldest of them, which is never replaced.
    angles.append(t.field.place(t.angles.pi))
    return _eliminate(t.field, x, angles, names, lambda k: _is_sum_of_angles(t, k, names))


def _is_number(u: Quotient) -> bool:
    return u.field.is_number(u.above) and u.field.is_number(u.below)


def _eliminate(
    field: Field, x: Poly, places: list[int], names: Names, is_relation: Callable[[Multiples], bool]
) -> Poly:
    remaining = list(places)
    # Each relation eliminates one unit, so the search is repeated with the others.
    while 1 < len(remaining) <= _MOST_UNITS:
        multiples = next((k for k in _candidates(field, remaining, names) if is_relation(k)), None)
        if multiples is None:
            break
        replaced = next(place for place in remaining if place in multiples)
        x = _replace_unit(field, x, multiples, replaced)
        remaining.remove(replaced)
    return x


def _candidates(field: Field, places: list[int], names: Names) -> Iterator[Multiples]:
    """Yield small multiples of units whose sum seems to be 0."""
    bits = _BITS_EACH * (len(places) + 1)
    with working_precision(2 * bits):
        point = Point(field, names())
        balls = [point.unit(place) * flint.arb(2) ** bits for place in places]
        if not all(ball.is_finite() and abs(ball) < flint.arb(2) ** (2 * bits) for ball in balls):
            return
        wholes = [int(ball.mid().floor().unique_fmpz() or 0) for ball in balls]
    # The rows (e_i, 2^bits·ball_i) span a lattice; a short vector of it is a relation with small
    # coefficients. LLL finds it where it exists, and the caller proves it.
    rows = [[*(int(i == j) for j in range(len(places))), w] for i, w in enumerate(wholes)]
    for row in flint.fmpz_mat(rows).lll().tolist():
        multiples = [int(k) for k in row[:-1]]
        size = sum(map(abs, multiples))
        if size <= _LARGEST_OF_NUMBERS and abs(int(row[-1])) <= 2 * size:
            yield {place: k for place, k in zip(places, multiples, strict=True) if k}


def _replace_unit(field: Field, x: Poly, multiples: Multiples, place: int) -> Poly:
    """Replace the unit of that place in x by the others in the relation."""
    gens, value, total = field.ring.gens, field.ring.zero, field.ring.zero
    for other, k in multiples.items():
        if other != place:
            value += gens[other] * flint.fmpq(-k, multiples[place])
    for n, part in split(x, place).items():
        total += field.multiply(part, value**n)
    return field.ring.reduce(total)


def _is_sum_of_logarithms(t: Translation, multiples: Multiples) -> bool:
    field, product = t.field, t.field.one
    try:
        for place, k in multiples.items():
            f = t.powers.logarithms[place]
            _check_multiple(k, number=field.is_number(f))
            product = product * field.polynomial(f) ** (2 * k)
        return vanishes(field, product.above - product.below)
    except UndecidedError:
        return False


def _is_sum_of_angles(t: Translation, multiples: Multiples, names: Names) -> bool:
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
    with working_precision(_BITS_OF_ANGLE):
        point = Point(field, names())
        total = sum((point.unit(place) * k for place, k in multiples.items()), flint.arb(0))
        return bool(abs(total) < 1)  # a multiple of π that is below 1 is 0


def _check_multiple(k: int, *, number: bool) -> None:
    if abs(k) > (_LARGEST_OF_NUMBERS if number else _LARGEST):
        raise UndecidedError("too high a power")
