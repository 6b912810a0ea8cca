"""Whether an algebraic number is 0, by a bound from below.

An algebraic integer that is not 0 has a norm of at least 1, so that with D conjugates, none larger
than B, it is itself at least B^(1 − D). A number that is a polynomial in roots and cosines is,
times a whole number, an algebraic integer, of which D and B are known without looking at it
(Mignotte; "constructive root bounds"): a ball narrower than that decides.
"""

import math
from dataclasses import replace

import flint
import gmpy2

from verify.algebra.identities.field import Algebraic, Field, Point, UndecidedError
from verify.algebra.identities.polynomials import Poly, by_monomials, occurring, terms_of
from verify.arithmetic.flint_precision import working_precision

MAX_DEGREE = 2000
_MAX_BITS = 200_000
_SIZE_BITS = 64


def size(field: Field, x: Poly) -> Algebraic:
    """What is known of a polynomial in algebraic numbers."""
    places = occurring(x)
    own = {place: field.units[place].number for place in places}
    all_degrees: dict[int, int] = {}
    divisor, degrees = math.lcm(*(int(c.q) for c in x.coeffs())), x.degrees()
    for place, number in own.items():
        assert number is not None  # noqa: S101 - the caller asks for numbers only
        all_degrees |= number.degrees
        divisor *= number.divisor ** degrees[place]
    if math.prod(all_degrees.values()) > MAX_DEGREE or divisor.bit_length() > _MAX_BITS:
        raise UndecidedError("numbers of too high a degree")
    with working_precision(_SIZE_BITS):
        house = flint.arb(0)
        for monomial, c in terms_of(x):
            term = flint.arb(abs(c))
            for place, number in own.items():
                if number is not None and monomial[place]:
                    term *= number.house ** int(monomial[place])
            house += term
        return Algebraic(all_degrees, divisor, house.abs_upper())


def number_sign(field: Field, x: Poly) -> int:
    """The sign of a polynomial in algebraic numbers: 1, −1 or, exactly, 0."""
    if x.is_zero():
        return 0
    own = size(field, x)
    with working_precision(_SIZE_BITS):
        largest = (own.house * own.divisor).max(flint.arb(1))
        bits = int(float((largest.log() / flint.arb(2).log()).abs_upper())) + 2
    needed = own.degree * bits + _SIZE_BITS
    if needed > _MAX_BITS:
        raise UndecidedError("numbers of too high a degree")
    precision = 2 * _SIZE_BITS
    while True:
        with working_precision(precision):
            ball = Point(field, {}).of(x)
            if not ball.contains(0):
                return 1 if ball > 0 else -1
            # |d·x| ≥ B^(1 − D) unless it is 0, and B < 2^bits.
            if abs(ball * own.divisor) < flint.arb(2) ** (-bits * (own.degree - 1)):
                return 0
        if precision > 4 * needed + 1024:
            raise UndecidedError("a number that is not enclosed")
        precision *= 2


def root_of(field: Field, x: Poly, degree: int) -> tuple[int, Algebraic]:
    """What is known of |x|^(1/degree), of a number x that is not 0; see `Field.unit`."""
    own = size(field, x)
    with working_precision(_SIZE_BITS):
        house = own.house.root(degree).abs_upper()
    return degree, replace(own, house=house)


def vanishes(field: Field, x: Poly) -> bool:
    """Whether the coefficients of x, by its powers of the functions in it, are all the number 0."""
    functions = {place for place in occurring(x) if field.units[place].number is None}
    parts = map(field.ring.context.from_dict, by_monomials(x, functions).values())
    return all(number_sign(field, part) == 0 for part in parts)


def rational_root(c: flint.fmpq, degree: int) -> flint.fmpq | None:
    """c^(1/degree) of c > 0, where it is rational."""
    (above, exact), (below, exact_below) = (gmpy2.iroot(int(x), degree) for x in (c.p, c.q))
    return flint.fmpq(int(above), int(below)) if exact and exact_below else None
