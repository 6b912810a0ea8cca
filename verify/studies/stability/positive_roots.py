"""The positive roots of polynomials with integer coefficients, exactly and in order.

flint isolates the roots of a polynomial of any degree by balls that do not meet, and gives a real
root the imaginary part 0, exactly (Arb's `arb_fmpz_poly_complex_roots`). Roots of different
polynomials are put in order by as many bits as that takes: different irreducible factors have no
root in common, so that enough bits separate them.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import flint
import sympy

from verify.arithmetic.arb import bounds
from verify.arithmetic.flint_precision import working_precision
from verify.effort import answer_unless_long

_BITS = 128


@dataclass(frozen=True)
class PositiveRoot:
    """The positive root with this `number`, from 1 upwards, of an irreducible polynomial."""

    polynomial: flint.fmpz_poly
    number: int

    def describe(self, variable: str) -> str:
        """Return the root in words, with the polynomial in that variable."""
        return f"positive root {self.number} of {self._in(sympy.Symbol(variable)).as_expr()}"

    def closed_form(self) -> sympy.Expr | None:
        """Return the root of a quadratic or a binomial polynomial in closed form; else None."""
        terms = sum(c != 0 for c in self.polynomial.coeffs())
        if self.polynomial.degree() > 2 and terms > 2:
            return None
        roots = answer_unless_long(lambda: self._in(sympy.Dummy()).real_roots(), None)
        return roots and sorted(x for x in roots if x > 0)[self.number - 1]

    def decimal(self, digits: int) -> str:
        """Return the root rounded to so many significant digits; it must not be rational."""
        bits = 4 * digits + _BITS
        while True:
            ends = bounds(_enclosures(self.polynomial, bits)[self.number - 1])
            low, high = (str(sympy.Rational(x.numerator, x.denominator).n(digits)) for x in ends)
            if low == high:
                return low
            bits *= 2

    def _in(self, variable: sympy.Symbol) -> sympy.Poly:
        return sympy.Poly([int(c) for c in reversed(self.polynomial.coeffs())], variable)


def positive_roots(
    polynomials: Iterable[flint.fmpz_poly],
) -> list[tuple[PositiveRoot, tuple[Fraction, Fraction]]]:
    """Return the positive roots of all polynomials in order, in intervals that do not meet.

    >>> [root.number for root, _ in positive_roots([flint.fmpz_poly([-2, 0, 1])])]
    [1]
    """
    factors = [g for f in polynomials for g, _ in f.factor()[1] if g.degree() > 0]
    different = [g for n, g in enumerate(factors) if g not in factors[:n]]
    bits = _BITS
    while True:
        roots = [(x, g, n) for g in different for n, x in enumerate(_enclosures(g, bits), 1)]
        roots.sort(key=lambda entry: bounds(entry[0])[0])
        # Balls that overlap do not decide an order: distinct roots separate with enough bits.
        if all(x < y for (x, _, _), (y, _, _) in pairwise(roots)):
            return [(PositiveRoot(g, n), bounds(x)) for x, g, n in roots]
        bits *= 2


def _enclosures(irreducible: flint.fmpz_poly, bits: int) -> list[flint.arb]:
    """Return enclosures of its positive roots, from the smallest one on."""
    # The polynomial is `inner`(x^power); `inner` has fewer roots.
    inner, power = irreducible.deflation()
    if inner.degree() == 1 and inner[0] == 0:
        return []
    with working_precision(bits):
        roots: Any = inner.complex_roots()  # pairs with the multiplicity; the stubs say otherwise
        return [x.real.root(power) for x, _ in roots if x.imag == 0 and x.real > 0]
