"""The differential ring in which zero is decided.

An expression becomes a polynomial, over the rationals, in the variables (p, q, h, parameters) and
in generators for what is not polynomial in them: sin b and cos b, exp b, sinh b and cosh b, log u,
atan u, u^(1/n), 1/u and π. Relations hold between generators (sin² + cos² = 1, w·u = 1, Rⁿ = u, …)
and each generator knows its derivative, so that the ring is closed under ∂/∂p, ∂/∂q and ∂/∂h.

Contract. `decide(x)` answers
- zero, when x with its denominators cleared reduces to 0 modulo the relations, here or in a field
  in which phases, factors under logarithms and roots, and algebraic numbers are distinguished (see
  `verify.algebra.zero_test`): exact algebra, and every relation is an identity of functions
  wherever x is defined;
- not zero, with a witness: a rational point at which an enclosure of x excludes 0 (Arb's ball
  arithmetic, so rounding is accounted for);
- neither (None), when the relations do not show it zero and no point shows it non-zero.
`simplify` plays no part in either. The third answer can occur only where generators hide an
identity, as exp(q √(3 + 2 √2)) does, or names of parts do; the callers report UNDECIDED.

Functions of sums are expanded over a basis of the lattice that their arguments span, so that
sin(p + q) and sin(p), or exp(q) and exp(2 q), are not treated as independent.
"""

from __future__ import annotations

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.differential_ring import RingFullError as RingFullError
from verify.algebra.generator import Poly as Poly
from verify.algebra.ring_text import as_expression, as_product, as_text
from verify.algebra.zero_test import Decision as Decision
from verify.algebra.zero_test import decide_zero
from verify.late import sympy

_MOST_FACTORS = 4


class Ring(DifferentialRing):
    """The ring of the given variables with room for `room` generators; see `embedding.embed`."""

    # -- the decision -------------------------------------------------------------------------

    def decide(self, x: Poly) -> Decision:
        """Decide whether x is the zero function; see the module's contract."""
        return decide_zero(self, self.reduce(x))

    def vanishes(self, x: Poly) -> bool | None:
        """Return `decide(x).zero`, without computing a witness where none is needed."""
        x = self.reduce(x)
        if x.is_zero():
            return True
        if self.in_variables(x):
            return False  # a polynomial that is not 0 is not the zero function
        return decide_zero(self, x).zero

    # -- quotients ----------------------------------------------------------------------------

    def inverse(self, u: Poly) -> Poly:
        """Return 1/u, by the inverses of u's irreducible factors (of u itself, if they are many).

        Raises ZeroDivisionError where u is zero, or cannot be shown not to be.
        """
        if self.decide(u).zero is not False:
            raise ZeroDivisionError
        content, factors = u.factor()
        # Each inverse is one more generator with a relation; many of them make every reduction
        # slower.
        if len(factors) > _MOST_FACTORS:
            content, factors = u.leading_coefficient(), [(u / u.leading_coefficient(), 1)]
        result = self.context.constant(1 / content)
        for factor, power in factors:
            result = self.multiply(result, self._inverse_of_irreducible(factor) ** int(power))
        return result

    def _inverse_of_irreducible(self, u: Poly) -> Poly:
        existing = self.find("inverse", u)
        if existing is not None:
            return existing
        w = self.add("inverse", u)
        self.relate(w, 1, w * u - 1)
        self.set_gradient(w, -(w**2), u)
        return w

    # -- text ---------------------------------------------------------------------------------

    def expression(self, x: Poly) -> sympy.Expr:
        """Convert x to an expression, with its terms as they stand in the ring."""
        return as_expression(self, x)

    def text(self, x: Poly) -> str:
        """Format x as a formula: factored where it has few terms, else as in the ring."""
        return as_text(self, x)

    def as_product(self, x: Poly) -> sympy.Expr:
        """Convert x to an expression, factored into irreducible polynomials in the generators."""
        return as_product(self, x)
