"""The differential ring in which zero is decided.

An expression becomes a polynomial, over the rationals, in the variables (p, q, h, parameters) and
in generators for what is not polynomial in them: sin b and cos b, exp b, sinh b and cosh b, log u,
atan u, u^(1/n), 1/u and π. Relations hold between generators (sin² + cos² = 1, w·u = 1, Rⁿ = u, …)
and each generator knows its derivative, so that the ring is closed under ∂/∂p, ∂/∂q and ∂/∂h.

Contract. `decide(x)` answers

- zero, if x with its denominators cleared reduces to 0 modulo the relations, here or in a field in
  which phases, factors under logarithms and roots, and algebraic numbers are distinguished (see
  `verify.algebra.hidden_zero`). This is exact algebra, and every relation is an identity of
  functions wherever x is defined;
- not zero, with a witness: a rational point at which a ball around x excludes 0 (by Arb's ball
  arithmetic, which accounts for rounding);
- neither (None), if the relations do not show that x is zero and no point shows that it is not.

`simplify` plays no part in this. The third answer can occur only if generators hide an identity, as
exp(q √(3 + 2 √2)) does; callers report it as UNDECIDED.

Functions of sums are expanded over a basis of the lattice that their arguments span, so that
sin(p + q) and sin(p), or exp(q) and exp(2 q), are not treated as independent.

A record holds a ring and an element of it as plain data, from which both are rebuilt without
parsing. It has the generators that `verify.algebra.embedding.embed` adds, and none of schemes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.differential_ring import RingFullError as RingFullError
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import function, symbol
from verify.algebra.identities.polynomials import Generator, places_in, terms_of
from verify.algebra.identities.polynomials import Poly as Poly
from verify.algebra.limits import undefined_values
from verify.algebra.zero_test import Decision as Decision
from verify.algebra.zero_test import decide_zero
from verify.functions import in_rings
from verify.lazy_sympy import sympy

_MAX_FACTORS = 4  # a product of more factors gets one inverse
_LONG_ARGUMENT = 100  # an argument with so many terms is not factored in texts
_MAX_FACTORED_TERMS = 300  # with more terms, factoring and sympy take seconds


class Ring(DifferentialRing):
    """The ring of the given variables with room for `room` generators; see `embedding.embed`."""

    # -- the decision -------------------------------------------------------------------------

    def decide(self, x: Poly) -> Decision:
        """Decide whether x is the zero function; see the module's contract."""
        return decide_zero(self, self.reduce(x))

    def vanishes(self, x: Poly) -> bool | None:
        """Return `decide(x).zero`; no witness is computed if none is needed."""
        x = self.reduce(x)
        if x.is_zero():
            return True
        if self.in_variables(x):
            return False  # a polynomial that is not 0 is not the zero function
        return decide_zero(self, x).zero

    # -- quotients ----------------------------------------------------------------------------

    def inverse(self, u: Poly) -> Poly:
        """Return 1/u, by the inverses of u's irreducible factors; of u itself if there are many.

        Raises ZeroDivisionError unless u is shown not to be the zero function.
        """
        if self.decide(u).zero is not False:
            raise ZeroDivisionError
        content, factors = u.factor()
        # Each inverse is one more generator with a relation, and makes every reduction slower.
        if len(factors) > _MAX_FACTORS:
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
        """Return x as an expression, with its terms as they stand in the ring."""
        return _sum_of_terms(x, self._expressions_of_generators(x))

    def expression_at(self, x: Poly, values: Mapping[sympy.Symbol, sympy.Expr]) -> sympy.Expr:
        """Return x at these values as an expression; nan if it is undefined there."""
        try:
            expressions = self._expressions_of_generators(x)
            generators = {k: g.xreplace(values) for k, g in expressions.items()}
            if any(g.has(*undefined_values()) for g in generators.values()):
                return self.expression(x).xreplace(values)
        except TypeError:  # sympy compared a nan inside with a number
            return sympy.nan
        return _sum_of_terms(x, generators)

    def as_product(self, x: Poly) -> sympy.Expr:
        """Return x as an expression, factored into irreducible polynomials in the generators."""
        if x.is_zero():
            return sympy.Integer(0)
        content, factors = x.factor()
        parts = [self.expression(f) ** int(n) for f, n in factors]
        return sympy.Mul(_rational(content), *parts)

    def text(self, x: Poly) -> str:
        """Return x as a formula: factored if it has few terms, else as it stands in the ring."""
        if len(x) <= _MAX_FACTORED_TERMS:
            return to_text(self.as_product(x))
        names = {
            f"_{g.index}": f"({to_text(self._generator_expression(g))})"
            for g in self.generators_in(x)
        }
        return re.sub(r"\b_\d+\b", lambda name: names[name[0]], str(x)).replace("^", "**")

    def _expressions_of_generators(self, x: Poly) -> dict[int, sympy.Expr]:
        """Return the expressions of the generators in x, by place."""
        generators = {g.index: g for g in self.generators}
        return {k: self._generator_expression(generators[k]) for k in places_in(x)}

    def _generator_expression(self, g: Generator) -> sympy.Expr:
        """Return the generator as an expression, which is cached."""
        if g.index not in self.expressions:
            self.expressions[g.index] = _apply_function(g, self._argument(g))
        return self.expressions[g.index]

    def _argument(self, g: Generator) -> sympy.Expr:
        """Return the generator's argument as an expression; 0 if it has none."""
        if g.argument is None:
            return sympy.S.Zero
        rule = in_rings().get(g.kind)
        # The factored argument is mostly the product that a user wrote; that of a pair is a sum.
        factored = rule is not None and rule.pair is None and len(g.inner) < _LONG_ARGUMENT
        return (self.as_product if factored else self.expression)(g.inner)


def _sum_of_terms(x: Poly, generators: Mapping[int, sympy.Expr]) -> sympy.Expr:
    terms = []
    for monomial, coefficient in terms_of(x):
        factors = [(generators[k], int(n)) for k, n in enumerate(monomial) if n]
        if all(g is not sympy.S.Zero for g, _ in factors):
            terms.append(sympy.Mul(_rational(coefficient), *(g**n for g, n in factors)))
    return sympy.Add(*terms)


def _apply_function(g: Generator, argument: sympy.Expr) -> sympy.Expr:
    """Return the generator's function of an expression; a variable and π ignore it."""
    if g.kind == "variable":
        return symbol(g.name)
    return _FUNCTIONS[g.kind](argument, g.degree)


def _by_name(name: str) -> Callable[[sympy.Expr, int], sympy.Expr]:
    return lambda x, _: function(name)(x)


_FUNCTIONS: dict[str, Callable[[sympy.Expr, int], sympy.Expr]] = {
    **{name: _by_name(name) for name in in_rings()},
    "root": lambda x, degree: x ** sympy.Rational(1, degree),
    "inverse": lambda x, _: 1 / x,
    "pi": lambda x, _: sympy.pi,
}


def _rational(value: flint.fmpq) -> sympy.Rational:
    """Convert a flint rational to sympy's."""
    return sympy.Rational(int(value.numer()), int(value.denom()))


# -- a ring and an element as plain data ----------------------------------------------------------

Record = dict[str, Any]  # the values are lists, texts and integers
_Terms = list[tuple[list[int], str, str]]  # exponents, numerator, denominator


def record_of(ring: Ring, x: Poly) -> Record:
    """Return the ring and its element x as data for JSON."""
    functions = [g for g in ring.generators if g.kind != "variable"]
    return {
        "variables": ring.variables,
        "room": ring.room,
        "generators": [
            [g.kind, None if g.argument is None else _terms(g.argument), g.degree]
            for g in functions
        ],
        "relations": [
            [index, power, _terms(relation)] for index, power, relation in ring.relations
        ],
        "gradients": [
            [g.index, {name: _terms(part) for name, part in ring.gradient(g.index).items()}]
            for g in functions
        ],
        "element": _terms(x),
    }


def ring_from_record(record: Mapping[str, Any]) -> tuple[Ring, Poly]:
    """Rebuild the ring and the element from their record."""
    ring = Ring(record["variables"], record["room"], spare=0)
    places = ring.context.gens()
    for kind, argument, degree in record["generators"]:
        ring.add(kind, None if argument is None else _poly(ring, argument), degree)
    # Generators are added first: relations and gradients refer to them by place.
    for index, power, relation in record["relations"]:
        ring.relate(places[index], power, _poly(ring, relation))
    for index, gradient in record["gradients"]:
        ring.set_partials(places[index], {n: _poly(ring, part) for n, part in gradient.items()})
    return ring, _poly(ring, record["element"])


def _terms(x: Poly) -> _Terms:
    # In hexadecimal, since Python reads no decimal number of more than 4300 digits.
    return [([*map(int, powers)], f"{int(c.p):x}", f"{int(c.q):x}") for powers, c in terms_of(x)]


def _poly(ring: Ring, terms: _Terms) -> Poly:
    return ring.context.from_dict(
        {tuple(powers): flint.fmpq(int(p, 16), int(q, 16)) for powers, p, q in terms}
    )
