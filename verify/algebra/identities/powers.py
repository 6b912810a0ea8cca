"""Powers |f|^r and logarithms log |f|, by the factors of f.

|·|^r and log |·| turn products into products and sums, whatever the signs of the factors. u > 0
wherever its root or its logarithm is defined, and there the root of u = c·Π fᵢ^nᵢ is
|c|^r·Π |fᵢ|^(r nᵢ): no sign of a factor is assumed. |f| is σ f with a unit σ, σ² = 1; σ is 1 or −1
if the sign of f is shown, or follows from u > 0.
"""

from fractions import Fraction
from math import lcm

import flint

from verify.algebra.identities.algebraic_numbers import bounds_of_root, number_sign
from verify.algebra.identities.field import Field, Quotient, UndecidedError
from verify.algebra.identities.polynomials import Poly
from verify.algebra.identities.signs import definite_sign

MAX_POWER = 256
_MAX_DIVISOR = 120
_MAX_NUMBER_BITS = 4000
_SMALL_PRIME_BITS = 16  # larger prime factors of a large number are not sought
_SMALL_NUMBER_BITS = 64  # a number up to this length is factored completely


class FinerError(Exception):
    """A unit must be divided more finely, and the field be built again."""


class Divisors:
    """The divisors of units, by kind and number of the unit; they are kept between attempts to
    build a field.

    The unit for e^u with the divisor d is e^(u/d): its d-th power is e^u.
    """

    def __init__(self) -> None:
        self.divisors: dict[tuple[str, int], int] = {}

    def divisor_of(self, kind: str, number: int, r: Fraction) -> int:
        """Return the divisor d of a unit. Raises FinerError if r is no integer multiple of 1/d."""
        divisor = self.divisors.get((kind, number), 1)
        if divisor % r.denominator:
            finer = lcm(divisor, r.denominator)
            if finer > _MAX_DIVISOR:
                raise UndecidedError("too fine a division")
            self.divisors[kind, number] = finer
            raise FinerError
        return divisor


class Powers:
    """The powers, logarithms and exponentials of one field."""

    def __init__(self, field: Field, finer: Divisors) -> None:
        self.field, self.finer = field, finer
        self.signs: dict[str, Quotient] = {}
        # By place: base and degree of a root, argument of an exponential, argument of a logarithm.
        self.roots: dict[int, tuple[Poly, int]] = {}
        self.exponents: dict[int, Quotient] = {}
        self.logarithms: dict[int, Poly] = {}
        self._numbers: dict[tuple[str, ...], int] = {}

    # -- signs --------------------------------------------------------------------------------

    def sign(self, f: Poly) -> Quotient:
        """Return σ with σ f = |f|, as a number or a unit."""
        field, key = self.field, str(f)
        if key not in self.signs:
            if field.is_number(f):
                sign_value: int | None = number_sign(field, f)
            else:
                sign_value = definite_sign(f, field)
            if sign_value is None:
                unit = field.unit(("sign", key), lambda at: at.enclose(f).sgn())
                field.relate(unit, 2, unit.above**2 - 1)
                self.signs[key] = unit
            elif sign_value == 0:
                raise UndecidedError("the root or logarithm of 0")
            else:
                self.signs[key] = field.number(sign_value)
        return field.polynomial(self.signs[key].above)

    def assume_positive(self, u: Quotient) -> None:
        """Record the assumption u > 0: the product of its factors' signs is 1."""
        field = self.field
        c, factors = self.factors(u)
        total = field.number(1 if c > 0 else -1)
        for f, n in factors:
            if n % 2 and self._may_be_negative(f):
                total = total * self.sign(f)
        if total.rational == -1:
            raise UndecidedError("the root or logarithm of what is negative")
        if total.rational is None:
            newest = field.ring.gens[field.place(total)]  # newest units are first
            unit = field.polynomial(newest)
            field.relate(unit, 1, newest - (total * unit).above)

    def _may_be_negative(self, f: Poly) -> bool:
        place = self.field.single(f)
        return place is None or not self.field.units[place].positive

    # -- factors ------------------------------------------------------------------------------

    def factors(self, u: Quotient) -> tuple[flint.fmpq, list[tuple[Poly, int]]]:
        """Factor u = c·Π f^n with irreducible polynomials f."""
        if u.is_zero or not self.field.is_small(u.above, u.below):
            raise UndecidedError("factors of what is 0, or too large")
        (a, above), (b, below) = u.above.factor(), u.below.factor()
        return a / b, [*((f, int(n)) for f, n in above), *((f, -int(n)) for f, n in below)]

    def prime_factors(self, c: flint.fmpq) -> list[tuple[int, int]]:
        """Return (prime, power) of the factors of |c|; a number too large to factor counts as
        prime."""
        factors = []
        for number, sign in ((abs(int(c.p)), 1), (int(c.q), -1)):
            if number.bit_length() > _MAX_NUMBER_BITS:
                raise UndecidedError("a number too large")
            small = number.bit_length() <= _SMALL_NUMBER_BITS
            integer = flint.fmpz(number)
            parts = integer.factor() if small else integer.factor_smooth(_SMALL_PRIME_BITS)
            factors += [(int(prime), sign * int(n)) for prime, n in parts if prime > 1]
        return factors

    def bases(self, u: Quotient) -> list[tuple[Poly, int]]:
        """Return (base, power) of the factors of |u|: of `prime_factors`, and of irreducible
        polynomials."""
        (c, factors), constant = self.factors(u), self.field.ring.context.constant
        return [*((constant(prime), n) for prime, n in self.prime_factors(c)), *factors]

    # -- powers -------------------------------------------------------------------------------

    def power(self, u: Quotient, r: Fraction) -> Quotient:
        """Return |u|^r."""
        if abs(r) > MAX_POWER:
            raise UndecidedError("too high a power")
        total = self.field.one
        for f, n in self.bases(u):
            total = total * self._power_of_base(f, n * r)
        return total

    def _power_of_base(self, f: Poly, e: Fraction) -> Quotient:
        """Return |f|^e for an irreducible f."""
        field, place = self.field, self.field.single(f)
        if place in self.roots:
            base, degree = self.roots[place]
            return self._power_of_base(base, e / degree)
        if place in self.exponents:
            return self.exponential(self.exponents[place].times(e))
        if abs(e) > MAX_POWER:
            raise UndecidedError("too high a power")
        integer = e.numerator // e.denominator
        fraction = e - integer
        total = field.polynomial(f)
        if integer % 2 and (self._may_be_negative(f) or field.is_number(f)):
            total = total**integer * self.sign(f)
        else:
            total = total**integer
        if not fraction:
            return total
        root, degree = self._root(f, fraction)
        return total * root ** int(fraction * degree)

    def _root(self, f: Poly, r: Fraction) -> tuple[Quotient, int]:
        """Return ρ with ρ^n = |f|, and n; r is a multiple of 1/n."""
        field, key = self.field, ("root", str(f))
        degree = self.finer.divisor_of("root", self.number(key), r)
        if key not in field.unit_by_key:
            sign = self.sign(f)
            number = bounds_of_root(field, f, degree) if field.is_number(f) else None
            unit = field.unit(
                key, lambda at: abs(at.enclose(f)).root(degree), positive=True, number=number
            )
            field.relate(unit, degree, unit.above**degree - (sign * field.polynomial(f)).above)
            self.roots[field.place(unit)] = f, degree
        return field.unit_by_key[key], degree

    def number(self, key: tuple[str, ...]) -> int:
        """Return the number of a key; keys are numbered in the order in which they first occur."""
        return self._numbers.setdefault(key, len(self._numbers))

    # -- logarithms ---------------------------------------------------------------------------

    def logarithm(self, u: Quotient) -> Quotient:
        """Return log |u|."""
        total = self.field.zero
        for f, n in self.bases(u):
            total += self._log_of(f).times(n)
        return total

    def _log_of(self, f: Poly) -> Quotient:
        field, place = self.field, self.field.single(f)
        if place in self.roots:
            base, degree = self.roots[place]
            return self._log_of(base).times(Fraction(1, degree))
        if place in self.exponents:
            return self.exponents[place]
        key = ("logarithm", str(f))
        if key not in field.unit_by_key:
            if field.is_number(f) and number_sign(field, f) == 0:
                raise UndecidedError("the logarithm of 0")
            unit = field.unit(key, lambda at: abs(at.enclose(f)).log())
            self.logarithms[field.place(unit)] = f
        return field.unit_by_key[key]

    # -- exponentials -------------------------------------------------------------------------

    def exponential(self, u: Quotient) -> Quotient:
        """Return exp u, term by term: exp(r log |f|) is |f|^r."""
        field = self.field
        total = field.one
        for r, term in field.terms(u):
            place = field.single(term.above) if term.below.is_one() else None
            if place in self.logarithms:
                total = total * self.power(field.polynomial(self.logarithms[place]), r)
            else:
                total = total * self._exponential_of(term, r)
        return total

    def _exponential_of(self, term: Quotient, r: Fraction) -> Quotient:
        """Return exp(r·term)."""
        field, key = self.field, ("exponential", term.key)
        share = self.finer.divisor_of("exponential", self.number(key), r)
        if key not in field.unit_by_key:
            part = term.times(Fraction(1, share))
            unit = field.unit(key, lambda at: at.quotient(part).exp(), positive=True)
            self.exponents[field.place(unit)] = part
        n = int(r * share)
        if abs(n) > MAX_POWER:
            raise UndecidedError("too high a power")
        return field.unit_by_key[key] ** n
