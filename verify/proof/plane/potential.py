"""Whether the leading coefficient L of ΔJ is X·G for one given H, whose structure may help.

Where H depends on time it is D·G, D = ∂_t + X, that is looked for.

True: G is given, and X·G − L is decided to be zero. False: at an equilibrium X·G = 0 for every
smooth G, and L is not zero there. None: neither is found. G is looked for by the formula for even
η, and else among the polynomials in what H and L are made of (p, q, parameters, sin, cos, …).
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import chain, combinations_with_replacement, islice, product

import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose, points
from verify.algebra.linear_combination import combination, may_combine
from verify.algebra.ring import Poly, Ring
from verify.algebra.symbols import P, Q
from verify.effort import unless_long
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.proof.proof import Proof
from verify.proof.telescoping import potential_of_lie
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.scheme import Scheme

_MOST_MONOMIALS, _MOST_DEGREE = 300, 20
_PLACES = (sympy.S.Zero, sympy.S.One, -sympy.S.One, sympy.pi, -sympy.pi)


@dataclass(frozen=True)
class Potential:
    """`holds`: whether L = X·G; `element`: that G in a ring; `reason`: how it is known."""

    holds: bool | None
    reason: str
    element: tuple[Ring, Poly] | None = None

    @cached_property
    def potential(self) -> sympy.Expr | None:
        """G as an expression."""
        if self.element is None:
            return sympy.S.Zero if self.holds else None
        ring, x = self.element
        return ring.factored(x)

    @property
    def text(self) -> str | None:
        """G as a formula."""
        if self.element is None:
            return "0" if self.holds else None
        ring, x = self.element
        return ring.text(x)


def potential_of(proof: Proof, scheme: Scheme | None = None) -> Potential:
    """Whether the leading coefficient that was proved telescopes; `scheme`: where it is known."""
    proof.step_map.hamiltonian.check_planar()
    if proof.area_preserving:
        return Potential(True, "ΔJ ≡ 0")
    if proof.order is None or proof.first.element is None:
        return Potential(None, "the leading coefficient is not known")
    field, leading = _in_a_field(proof)
    # D·G need not vanish where the motion rests: there it is ∂G/∂t.
    where = None if field.timed else _equilibrium_against(field, leading)
    if where is not None:
        return Potential(
            False, f"X·G vanishes at the equilibrium {where}, for any smooth G; L does not"
        )
    every_h = scheme and scheme.every_h
    if isinstance(every_h, TaylorSeries) and every_h.eta % 2 == 0:
        found: Poly | None = potential_of_lie(field, every_h.eta).divergence
        how = "by the formula for every H"
    else:
        used = *field.slopes, leading
        found = among_polynomials(field.ring, used, field.derive, leading)
        how = "by linear algebra over monomials"
    if found is not None and field.ring.decide(field.derive(found) - leading).zero is True:
        return Potential(True, how, (field.ring, found))
    return Potential(None, "no G is found, and no equilibrium at which L is not zero")


def _in_a_field(proof: Proof) -> tuple[CanonicalField, Poly]:
    """The vector field of H and the leading coefficient, as elements of one ring."""
    assert proof.first.element is not None  # noqa: S101 - the caller's condition
    ring, leading = proof.first.element
    for own in (proof.step_map.field, *(x.field for x in (proof.step_map.closed,) if x)):
        if own.ring is ring:
            return own, leading
    field, (leading,) = canonical_field(proof.step_map.hamiltonian, proof.leading)
    return field, leading


def _equilibrium_against(field: CanonicalField, leading: Poly) -> str | None:
    """An equilibrium at which L is shown not to vanish (for some values of the parameters)."""
    ring = field.ring
    force = [ring.expression(x) for x in field.slopes]
    for p, q in sorted(product(_PLACES, repeat=2), key=lambda at: _PLACES.index(at[0])):
        put = {P: p, Q: q}
        try:
            if not unless_long(partial(_rests, force, put), otherwise=False):
                continue
            if p.is_Rational and q.is_Rational:
                there = _not_zero_at(ring, leading, Fraction(int(p)), Fraction(int(q)))
            else:
                there = len(leading) <= _MOST_MONOMIALS and _not_zero(
                    unless_long(partial(ring.expression(leading).subs, put), sympy.S.Zero),
                    ring.variables,
                )
        except (InputError, ZeroDivisionError):
            continue  # H is not defined there
        if there:
            return f"p = {p}, q = {q}"
    return None


def _rests(force: Sequence[sympy.Expr], at: Mapping[sympy.Expr, sympy.Expr]) -> bool:
    return all(sympy.expand(x.subs(at)) == 0 for x in force)


def _not_zero_at(ring: Ring, x: Poly, p: Fraction, q: Fraction) -> bool:
    names = [n for n in ring.variables if n not in ("p", "q", "h")]
    for others in islice(points(names), 4):
        value = enclose(ring, x, {**others, "p": p, "q": q}, 128)
        if value is not None and not value.contains(0):
            return True
    return False


def _not_zero(value: sympy.Expr, variables: tuple[str, ...]) -> bool:
    if not value.is_finite and not value.free_symbols:
        return False
    ring, (x,) = embed([value], variables)
    return ring.decide(x).zero is False


def among_polynomials(
    ring: Ring, used: Sequence[Poly], derive: Callable[[Poly], Poly], wanted: Poly
) -> Poly | None:
    """A polynomial G with derive(G) = wanted in normal form, of the least degree that has one.

    `used`: G is made of what these elements are made of, and of p and q. `derive` is linear.
    """
    indices = [g.index for g in ring.generators_in(*used, ring.variable("p"))]
    gens = [
        x for k, x in enumerate(ring.context.gens()) if k in indices and x != ring.variable("h")
    ]
    if ring.variable("q") not in gens:
        gens.append(ring.variable("q"))
    degrees = list(_by_degree(gens, ring.one))
    moved = [[derive(m) for m in monomials] for monomials in degrees]
    if not may_combine(list(chain(*moved)), wanted):
        return None
    for most in range(1, len(degrees) + 1):
        found, _ = combination(list(chain(*moved[:most])), wanted)
        if found is not None:
            monomials = list(chain(*degrees[:most]))
            return sum((c * monomials[k] for k, c in found.items()), ring.zero)
    return None


def _by_degree(gens: list[Poly], one: Poly) -> Iterator[list[Poly]]:
    """The monomials of degree 1, 2, …, up to where they are too many in all."""
    for degree in range(1, _MOST_DEGREE):
        if math.comb(len(gens) + degree, degree) > _MOST_MONOMIALS:
            return
        chosen = combinations_with_replacement(gens, degree)
        yield [math.prod(factors, start=one) for factors in chosen]
