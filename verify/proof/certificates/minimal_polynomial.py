"""The irreducible polynomial with whole coefficients of a number expressed by roots.

A generator of a ring without variables is the root, or the inverse, of a number u that is a
polynomial in older generators, u = x(g_1, …, g_k). Let P_j be the minimal polynomial of g_j. The
resultant of X − x(x_1, …, x_k) and P_1(x_1), then of that and P_2(x_2), and so on, vanishes at
X = u. With f(u) = 0, f(wⁿ) is 0 for the n-th root w, and the reversed f for 1/u. The irreducible
factor that vanishes at the number is the one whose enclosures there never exclude 0.
"""

from math import prod

import flint

from verify.algebra.enclosure import enclose
from verify.algebra.generator import Poly, terms_of
from verify.algebra.identities.polynomials import places_in
from verify.algebra.ring import Ring
from verify.arithmetic.flint_precision import working_precision

_PRECISIONS = (256, 1024, 4096)


class MinimalPolynomials:
    """The minimal polynomials of the generators of one ring, up to a degree of `most`."""

    def __init__(self, ring: Ring, most: int) -> None:
        self.ring, self.most = ring, most
        self._kinds = {g.index: g for g in ring.generators}
        self._cache: dict[int, flint.fmpz_poly] = {}

    def polynomial_of(self, index: int) -> flint.fmpz_poly:
        """Return the minimal polynomial of the generator; ValueError says why there is none."""
        if index not in self._cache:
            self._cache[index] = self._compute(index)
        return self._cache[index]

    def _compute(self, index: int) -> flint.fmpz_poly:
        g = self._kinds[index]
        if g.kind not in ("root", "inverse"):
            raise ValueError("is not made by roots")
        inner = self._of_element(g.inner)
        if g.kind == "inverse":
            # X^n f(1/X) vanishes at 1/u where f vanishes at u.
            polynomial = flint.fmpz_poly(inner.coeffs()[::-1])
        else:
            self._check(inner.degree() * g.degree)
            polynomial = inner.inflate(g.degree)
        return self._factor(polynomial, self.ring.context.gens()[index])

    def _of_element(self, x: Poly) -> flint.fmpz_poly:
        if x.is_constant():
            c = x.leading_coefficient()
            return flint.fmpz_poly([-int(c.p), int(c.q)])
        places = places_in(x)
        self._check(prod(self.polynomial_of(place).degree() for place in places))
        # X − x, from which one generator after the other is taken by its own polynomial.
        names = ["x", *(f"_{place}" for place in places)]
        context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex)
        variable, *generators = context.gens()
        resultant = variable - context.from_dict(
            {(0, *(monomial[place] for place in places)): c for monomial, c in terms_of(x)}
        )
        for name, gen, place in zip(names[1:], generators, places, strict=True):
            powers = (c * gen**n for n, c in enumerate(self.polynomial_of(place).coeffs()))
            resultant = resultant.resultant(sum(powers, context.constant(0)), name)
        by_power = {powers[0]: c for powers, c in terms_of(resultant)}
        coefficients = [by_power.get(n, 0) for n in range(max(by_power) + 1)]
        return self._factor(flint.fmpq_poly(coefficients).numer(), x)

    def _check(self, degree: int) -> None:
        if degree > self.most:
            raise ValueError(f"is of degree {degree}, or seems so; allowed: up to {self.most}")

    def _factor(self, polynomial: flint.fmpz_poly, x: Poly) -> flint.fmpz_poly:
        """Return the irreducible factor that vanishes at x."""
        factors = [factor for factor, _ in polynomial.factor()[1]]
        for precision in _PRECISIONS:
            ball = enclose(self.ring, x, {}, precision)
            with working_precision(precision):
                factors = [f for f in factors if ball is None or f(ball).contains(0)]
            if len(factors) == 1:
                return factors[0]
        raise ValueError("is not told from other numbers")
