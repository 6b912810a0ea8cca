"""The decision whether an algebraic number is 0, by a lower bound on its size.

The norm of an algebraic integer ≠ 0, the product of its D conjugates, is at least 1 in size. If
none of them is larger than B, the integer itself is at least B^(1 − D) in size. A polynomial in
roots and cosines, times an integer, is an algebraic integer, and D and B follow from the roots and
cosines alone (Mignotte; "constructive root bounds"). A ball narrower than the bound decides.
"""

import math
from dataclasses import replace

import flint
import gmpy2

from verify.algebra.identities.field import Algebraic, Field, Point, UndecidedError
from verify.algebra.identities.polynomials import Poly, places_in, split_by_monomials, terms_of
from verify.arithmetic.flint_precision import working_precision

MAX_DEGREE = 2000
_MAX_BITS = 200_000
_SIZE_BITS = 64


def bounds_of(field: Field, x: Poly) -> Algebraic:
    """Return bounds on a polynomial in algebraic numbers: its degrees, divisor and house."""
    places = places_in(x)
    numbers = {place: field.units[place].number for place in places}
    all_degrees: dict[int, int] = {}
    divisor, degrees = math.lcm(*(int(c.q) for c in x.coeffs())), x.degrees()
    for place, number in numbers.items():
        assert number is not None  # noqa: S101 - the caller asks for numbers only
        all_degrees |= number.degrees
        divisor *= number.divisor ** degrees[place]
    if math.prod(all_degrees.values()) > MAX_DEGREE or divisor.bit_length() > _MAX_BITS:
        raise UndecidedError("numbers of too high a degree")
    with working_precision(_SIZE_BITS):
        house = flint.arb(0)
        for monomial, c in terms_of(x):
            term = flint.arb(abs(c))
            for place, number in numbers.items():
                if number is not None and monomial[place]:
                    term *= number.house ** int(monomial[place])
            house += term
        return Algebraic(all_degrees, divisor, house.abs_upper())


def number_sign(field: Field, x: Poly) -> int:
    """Return the sign of a polynomial in algebraic numbers: 1, −1 or, exactly, 0."""
    if x.is_zero():
        return 0
    bounds = bounds_of(field, x)
    with working_precision(_SIZE_BITS):
        largest = (bounds.house * bounds.divisor).max(flint.arb(1))
        bits = int(float((largest.log() / flint.arb(2).log()).abs_upper())) + 2
    most_bits = bounds.degree * bits + _SIZE_BITS
    if most_bits > _MAX_BITS:
        raise UndecidedError("numbers of too high a degree")
    precision = 2 * _SIZE_BITS
    while True:
        with working_precision(precision):
            ball = Point(field, {}).enclose(x)
            if not ball.contains(0):
                return 1 if ball > 0 else -1
            # |d·x| ≥ B^(1 − D) unless x is 0, and B < 2^bits.
            if abs(ball * bounds.divisor) < flint.arb(2) ** (-bits * (bounds.degree - 1)):
                return 0
        if precision > 4 * most_bits + 1024:
            raise UndecidedError("a number that is not enclosed")
        precision *= 2


def bounds_of_root(field: Field, x: Poly, degree: int) -> tuple[int, Algebraic]:
    """Return bounds on |x|^(1/degree) for a number x ≠ 0, as the argument `number` of
    `Field.unit`."""
    bounds = bounds_of(field, x)
    with working_precision(_SIZE_BITS):
        house = bounds.house.root(degree).abs_upper()
    return degree, replace(bounds, house=house)


def vanishes(field: Field, x: Poly) -> bool:
    """Return True if x is 0 as a polynomial in functions: its coefficients, which are algebraic
    numbers, are all 0."""
    functions = {place for place in places_in(x) if field.units[place].number is None}
    parts = map(field.ring.context.from_dict, split_by_monomials(x, functions).values())
    return all(number_sign(field, part) == 0 for part in parts)


def rational_root(c: flint.fmpq, degree: int) -> flint.fmpq | None:
    """Return c^(1/degree) of c > 0 if it is rational, else None."""
    (above, above_is_power), (below, below_is_power) = (
        gmpy2.iroot(int(x), degree) for x in (c.p, c.q)
    )
    return flint.fmpq(int(above), int(below)) if above_is_power and below_is_power else None
