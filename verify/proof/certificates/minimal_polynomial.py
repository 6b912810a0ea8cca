"""The irreducible polynomial with whole coefficients of a number that is made by roots.

A generator of a ring without variables is the root, or the inverse, of a number u that older
generators make. Let u be x(g_1, …, g_k), x a polynomial and P_j that of g_j. Then u is an
eigenvalue of the multiplication by x in Q[x_1, …, x_k]/(P_1, …, P_k), so that its characteristic
polynomial vanishes at u: as the companion matrices of the P_j do, of each in its own factor of the
tensor product. With f(u) = 0, f(wⁿ) is 0 for the n-th root w, and the reversed f for 1/u. Of the
irreducible factors the one is taken of which no enclosure at the number excludes 0.
"""

from collections.abc import Sequence
from math import prod

import flint

from verify.algebra.enclosure import enclose
from verify.algebra.generator import Poly, terms_of
from verify.algebra.identities.polynomials import occurring
from verify.algebra.ring import Ring
from verify.arithmetic.flint_precision import working_precision

_PRECISIONS = (256, 1024, 4096)


class MinimalPolynomials:
    """Those of the generators of one ring, up to a degree of `most`."""

    def __init__(self, ring: Ring, most: int) -> None:
        self.ring, self.most = ring, most
        self._kinds = {g.index: g for g in ring.generators}
        self._known: dict[int, flint.fmpz_poly] = {}

    def of(self, index: int) -> flint.fmpz_poly:
        """That of the generator; ValueError says why there is none."""
        if index not in self._known:
            self._known[index] = self._made(index)
        return self._known[index]

    def _made(self, index: int) -> flint.fmpz_poly:
        g = self._kinds[index]
        if g.kind not in ("root", "inverse"):
            raise ValueError("is not made by roots")
        inner = [int(c) for c in self._of_element(g.inner).coeffs()]
        if g.kind == "inverse":
            found = flint.fmpz_poly(inner[::-1])
        else:
            self._check((len(inner) - 1) * g.degree)
            gaps = [0] * (g.degree - 1)
            found = flint.fmpz_poly([x for c in inner[:-1] for x in (c, *gaps)] + inner[-1:])
        return self._factor(found, self.ring.context.gens()[index])

    def _of_element(self, x: Poly) -> flint.fmpz_poly:
        if x.is_constant():
            c = x.leading_coefficient()
            return flint.fmpz_poly([-int(c.p), int(c.q)])
        places = occurring(x)
        self._check(prod(self.of(place).degree() for place in places))
        own = dict(zip(places, _commuting([self.of(place) for place in places]), strict=True))
        size = next(iter(own.values())).nrows()
        one = flint.fmpq_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])
        total = one * 0
        for monomial, c in terms_of(x):
            term = one * c
            for place in places:
                for _ in range(int(monomial[place])):
                    term = term * own[place]
            total += term
        return self._factor(total.charpoly().numer(), x)

    def _check(self, degree: int) -> None:
        if degree > self.most:
            raise ValueError(f"is of degree {degree}, or seems so; allowed: up to {self.most}")

    def _factor(self, polynomial: flint.fmpz_poly, x: Poly) -> flint.fmpz_poly:
        """The irreducible factor that vanishes at x."""
        factors = [factor for factor, _ in polynomial.factor()[1]]
        for precision in _PRECISIONS:
            ball = enclose(self.ring, x, {}, precision)
            with working_precision(precision):
                factors = [f for f in factors if ball is None or _at(f, ball).contains(0)]
            if len(factors) == 1:
                return factors[0]
        raise ValueError("is not told from other numbers")


def _at(polynomial: flint.fmpz_poly, x: flint.arb) -> flint.arb:
    total = flint.arb(0)
    for c in reversed(polynomial.coeffs()):
        total = total * x + c
    return total


def _commuting(polynomials: Sequence[flint.fmpz_poly]) -> list[flint.fmpq_mat]:
    """The companion matrix of each, in its own factor of the tensor product."""
    found = []
    before, size = 1, prod(p.degree() for p in polynomials)
    for p in polynomials:
        own, after = _companion(p), size // (before * p.degree())
        entries = [
            own[i // after % p.degree()][j // after % p.degree()]
            if i % after == j % after and i // (after * p.degree()) == j // (after * p.degree())
            else flint.fmpq(0)
            for i in range(size)
            for j in range(size)
        ]
        found.append(flint.fmpq_mat(size, size, entries))
        before *= p.degree()
    return found


def _companion(p: flint.fmpz_poly) -> list[list[flint.fmpq]]:
    """The multiplication by x modulo p."""
    *tail, first = (int(c) for c in p.coeffs())
    n = len(tail)
    return [
        [
            flint.fmpq(-tail[i], first) if j == n - 1 else flint.fmpq(int(i == j + 1))
            for j in range(n)
        ]
        for i in range(n)
    ]
