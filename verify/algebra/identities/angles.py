"""Cosines and sines of parts of an angle and of parts of a turn.

cos and sin of k b are polynomials in those of b, with the one relation sin² + cos² = 1. With
`tangents` they are quotients of polynomials in t = tan(b/2) instead, which need no relation, and
factor uniquely. Rational multiples of π are split off by the addition theorems; their cosines
and sines are polynomials in one number, c = 2 cos(2π/N), whose minimal polynomial is at hand. cos
and sin of k·atan u are the real and the imaginary part of (1 + iu)^k/(1 + u²)^(k/2).
"""

import math
from fractions import Fraction

import flint

from verify.algebra.identities.field import Algebraic, Field, Quotient, UndecidedError
from verify.algebra.identities.polynomials import Poly
from verify.algebra.identities.powers import MAX_POWER, FinerError, Powers

_MAX_PARTS = 840
_MAX_HALF_DEGREE = 120

Pair = tuple[Quotient, Quotient]  # cosine and sine, or real and imaginary part


def times(x: Pair, y: Pair) -> Pair:
    """Return the product of two complex numbers."""
    (a, b), (c, d) = x, y
    return a * c - b * d, a * d + b * c


def power(x: Pair, n: int) -> Pair:
    """Return xⁿ, n ≥ 0."""
    if n == 0:
        return x[0].field.one, x[0].field.zero
    half = power(x, n // 2)
    square = times(half, half)
    return times(square, x) if n % 2 else square


class Angles:
    """The cosines and sines of one field."""

    def __init__(self, field: Field, powers: Powers, *, tangents: bool) -> None:
        self.field, self.powers, self.tangents = field, powers, tangents
        self.arctangents: dict[int, Quotient] = {}  # place of an arctangent → its argument

    @property
    def pi(self) -> Quotient:
        field = self.field
        return field.unit_by_key.get(("pi",)) or field.unit(
            ("pi",), lambda _: flint.arb.pi(), positive=True
        )

    def arctangent(self, u: Quotient) -> Quotient:
        field = self.field
        if u.is_zero:
            return u
        if u.above.leading_coefficient() < 0:
            return -self.arctangent(-u)
        if u.rational == 1:
            return self.pi.times(Fraction(1, 4))
        key = ("arctangent", u.key)
        if key not in field.unit_by_key:
            unit = field.unit(key, lambda at: at.quotient(u).atan())
            self.arctangents[field.place(unit)] = u
        return field.unit_by_key[key]

    # -- cosine and sine ----------------------------------------------------------------------

    def cos_and_sin(self, angle: Quotient) -> Pair:
        """Return cos and sin of the angle."""
        field = self.field
        total = field.one, field.zero
        for r, term in field.terms(angle):
            place = field.single(term.above) if term.below.is_one() else None
            if term == self.pi:
                part = self._cos_and_sin_of_turn(r / 2)
            elif place in self.arctangents and r.denominator == 1:
                part = self.multiple_of_arctangent(self.arctangents[place], r.numerator)
            else:
                part = self._cos_and_sin_of_term(term, r)
            total = times(total, part)
        return total

    def _cos_and_sin_of_term(self, term: Quotient, r: Fraction) -> Pair:
        key = ("angle", term.key)
        share = self.powers.finer.divisor_of("angle", self.powers.number(key), r)
        n = int(r * share)
        if abs(n) > MAX_POWER:
            raise UndecidedError("too high a multiple of an angle")
        part = term.times(Fraction(1, share))
        if self.tangents:
            return self.multiple_of_arctangent(self._tangent(part), 2 * n)
        even, odd = power(self._circle(part), abs(n))
        return even, odd if n > 0 else -odd

    def _tangent(self, angle: Quotient) -> Quotient:
        """Return tan(angle/2)."""
        field, key = self.field, ("tangent", angle.key)
        half = angle.times(Fraction(1, 2))
        return field.unit_by_key.get(key) or field.unit(key, lambda at: at.quotient(half).tan())

    def _circle(self, angle: Quotient) -> Pair:
        field, keys = self.field, (("cos", angle.key), ("sin", angle.key))
        if keys[0] not in field.unit_by_key:
            c = field.unit(keys[0], lambda at: at.quotient(angle).cos(), bounded=True)
            s = field.unit(keys[1], lambda at: at.quotient(angle).sin(), bounded=True)
            field.relate(s, 2, s.above**2 + c.above**2 - 1)
        return field.unit_by_key[keys[0]], field.unit_by_key[keys[1]]

    def multiple_of_arctangent(self, t: Quotient, k: int) -> Pair:
        """Return cos and sin of k·atan t."""
        if abs(k) > MAX_POWER:
            raise UndecidedError("too high a multiple of an angle")
        even, odd = power((self.field.one, t), abs(k))
        below = self.field.one + t * t
        half = Fraction(abs(k), 2)
        size = self.powers.power(below, half) if k % 2 else below ** int(half)
        return even / size, (odd if k > 0 else -odd) / size

    # -- parts of a turn ----------------------------------------------------------------------

    def _cos_and_sin_of_turn(self, r: Fraction) -> Pair:
        """Return cos and sin of 2π r."""
        divisors, denominator = self.powers.finer.divisors, math.lcm(4, r.denominator)
        parts = divisors.get(("turn", 0), 1)
        if parts % denominator:
            parts = math.lcm(parts, denominator)
            if parts > _MAX_PARTS or flint.fmpz_poly.cos_minpoly(parts).degree() > _MAX_HALF_DEGREE:
                raise UndecidedError("too fine a part of a turn")
            divisors["turn", 0] = parts
            raise FinerError
        k = int(r * parts) % parts
        return self._cosine(k, parts), self._cosine(k - parts // 4, parts)

    def _cosine(self, k: int, parts: int) -> Quotient:
        """Return cos(2π k/parts), by the Chebyshev polynomial of c = 2 cos(2π/parts)."""
        field, key = self.field, ("cosine",)
        k = min(k % parts, -k % parts)
        minimal = flint.fmpz_poly.cos_minpoly(parts)
        if key not in field.unit_by_key:
            bounds = Algebraic({}, 1, flint.arb(2))
            unit = field.unit(
                key,
                lambda _: 2 * flint.arb.cos_pi_fmpq(flint.fmpq(2, parts)),
                positive=parts > 4,
                number=(minimal.degree(), bounds),
            )
            relation = self._in_cosine(minimal, unit)
            field.relate(unit, minimal.degree(), relation)
        # 2 cos((k + 1) a) = c·2 cos(k a) − 2 cos((k − 1) a)
        current, following = flint.fmpz_poly([2]), flint.fmpz_poly([0, 1]) % minimal
        for _ in range(k):
            current, following = (
                following,
                (flint.fmpz_poly([0, 1]) * following - current) % minimal,
            )
        return field.polynomial(self._in_cosine(current, field.unit_by_key[key]) / 2)

    def _in_cosine(self, x: flint.fmpz_poly, c: Quotient) -> Poly:
        place = self.field.place(c)
        length = len(self.field.ring.gens)
        return self.field.ring.context.from_dict(
            {
                tuple(n if k == place else 0 for k in range(length)): flint.fmpq(value)
                for n, value in enumerate(x.coeffs())
            }
        )
