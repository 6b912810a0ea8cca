"""The search for a G with X·G = L, the leading coefficient of a defect, for one H.

If H depends on time, D·G = L is solved instead, D = ∂_t + X.

The answer is True if there is a G for which X·G − L is decided to be zero; False if L is not zero
at an equilibrium, as X·G = 0 there for every smooth G; and None if neither is shown. For `lieη` of
even η a formula gives G; else G is searched among the polynomials in the generators of H and L (p,
q, parameters, sin, cos, …).
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import chain, combinations_with_replacement, islice, product

import sympy

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose, points
from verify.algebra.formula import symbol
from verify.algebra.linear_algebra import may_combine, solve_combination
from verify.algebra.ring import Poly, Ring
from verify.effort import answer_unless_long
from verify.errors import InputError
from verify.hamiltonians.canonical_field import PlainField, field_of
from verify.hamiltonians.coordinates import PLANE
from verify.proof.proof_for_one_h import Proof
from verify.proof.telescoping import potential_of_lie
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.scheme import Scheme

_MOST_MONOMIALS, _MOST_DEGREE, _MOST_EQUILIBRIA = 300, 20, 125
# Values of the coordinates at which an equilibrium is searched.
_VALUES = (sympy.S.Zero, sympy.S.One, -sympy.S.One, sympy.pi, -sympy.pi)


@dataclass(frozen=True)
class Potential:
    """The answer whether L = X·G.

    `holds`: None if undecided. `element`: G in its ring; None if there is no G, and if L = 0.
    """

    holds: bool | None
    reason: str
    element: tuple[Ring, Poly] | None = None

    @cached_property
    def potential(self) -> sympy.Expr | None:
        """The potential G as an expression; None if there is none."""
        if self.element is None:
            return sympy.S.Zero if self.holds else None
        ring, x = self.element
        return ring.as_product(x)

    @property
    def text(self) -> str | None:
        """The potential G as a formula; None if there is none."""
        if self.element is None:
            return "0" if self.holds else None
        ring, x = self.element
        return ring.text(x)


def potential_of(proof: Proof, scheme: Scheme | None = None) -> Potential:
    """Decide whether the leading coefficient of a proof telescopes.

    `scheme`: the map's scheme, if it has one; for lieη of even η the formula gives G.
    """
    proof.step_map.hamiltonian.check_planar()
    if proof.area_preserving:
        return Potential(True, "ΔJ ≡ 0")
    if proof.order is None or proof.first.element is None:
        return Potential(None, "the leading coefficient is not known")
    field, leading = _in_one_ring(proof)
    every_h = scheme and scheme.every_h
    formula = None
    if isinstance(every_h, TaylorSeries) and every_h.eta % 2 == 0:
        eta = every_h.eta
        formula = lambda: potential_of_lie(field, eta).divergence  # noqa: E731
    return potential_along(field, leading, formula, proof.step_map.domain)


def potential_along(
    field: PlainField,
    leading: Poly,
    formula: Callable[[], Poly] | None = None,
    domain: FormulaDomain = EVERYWHERE,
) -> Potential:
    """Decide whether L = X·G in a domain, D·G if the system depends on time.

    `formula`: returns a G that holds by a theorem; without it G is searched.
    """
    # At an equilibrium D·G is ∂G/∂t, which need not vanish.
    equilibrium = None if field.timed else _equilibrium_against(field, leading, domain)
    if equilibrium is not None:
        return Potential(
            False, f"X·G vanishes at the equilibrium {equilibrium}, for any smooth G; L does not"
        )
    if formula is not None:
        candidate: Poly | None = formula()
        reason = "by the formula for every H"
    else:
        elements = *field.slopes, leading
        candidate = among_polynomials(field.ring, elements, field.derive, leading, field.names)
        reason = "by linear algebra over monomials"
    if candidate is not None and field.ring.decide(field.derive(candidate) - leading).zero is True:
        return Potential(True, reason, (field.ring, candidate))
    return Potential(None, "no G is found, and no equilibrium at which L is not zero")


def _in_one_ring(proof: Proof) -> tuple[PlainField, Poly]:
    """Return the vector field of H and the leading coefficient, as elements of one ring."""
    assert proof.first.element is not None  # noqa: S101 - the caller's condition
    ring, leading = proof.first.element
    for candidate in (proof.step_map.field, *(x.field for x in (proof.step_map.closed,) if x)):
        if candidate.ring is ring:
            return candidate, leading
    field, (leading,) = field_of(proof.step_map.hamiltonian, proof.leading)
    return field, leading


def _equilibrium_against(field: PlainField, leading: Poly, domain: FormulaDomain) -> str | None:
    """Find an equilibrium of the domain at which L does not vanish, for some parameter values."""
    ring = field.ring
    force = [ring.expression(x) for x in field.slopes]
    for numbers in islice(product(_VALUES, repeat=len(field.names)), _MOST_EQUILIBRIA):
        values = {symbol(name): x for name, x in zip(field.names, numbers, strict=True)}
        try:
            if not answer_unless_long(partial(_rests, force, values), otherwise=False):
                continue
            domain.substitute(values)  # InputError outside of it, where G need not be smooth
            if all(x.is_Rational for x in numbers):
                point = dict(zip(field.names, map(Fraction, map(int, numbers)), strict=True))
                nonzero = _not_zero_at(ring, leading, point)
            else:
                nonzero = len(leading) <= _MOST_MONOMIALS and _not_zero(
                    answer_unless_long(
                        partial(ring.expression(leading).subs, values), sympy.S.Zero
                    ),
                    ring.variables,
                )
        except (InputError, ZeroDivisionError):
            continue  # H is not defined there
        if nonzero:
            return ", ".join(f"{name} = {x}" for name, x in values.items())
    return None


def _rests(force: Sequence[sympy.Expr], point: Mapping[sympy.Expr, sympy.Expr]) -> bool:
    return all(sympy.expand(x.subs(point)) == 0 for x in force)


def _not_zero_at(ring: Ring, x: Poly, point: Mapping[str, Fraction]) -> bool:
    names = [n for n in ring.variables if n not in point and n != "h"]
    for values in islice(points(names), 4):
        value = enclose(ring, x, {**values, **point}, 128)
        if value is not None and not value.contains(0):
            return True
    return False


def _not_zero(value: sympy.Expr, variables: tuple[str, ...]) -> bool:
    if not value.is_finite and not value.free_symbols:
        return False
    ring, (x,) = embed([value], variables)
    return ring.decide(x).zero is False


def among_polynomials(
    ring: Ring,
    elements: Sequence[Poly],
    derive: Callable[[Poly], Poly],
    target: Poly,
    names: Sequence[str] = PLANE,
) -> Poly | None:
    """Find a polynomial G of least degree with derive(G) = target in normal form.

    G is a polynomial in the coordinates and the generators of `elements`; `derive` is linear. None
    if there is none within the limits of degree and monomials.
    """
    coordinates = list(map(ring.variable, names))
    indices = [g.index for g in ring.generators_in(*elements, coordinates[0])]
    # h is no function of z, and G is a coefficient of a series in h.
    gens = [
        x for k, x in enumerate(ring.context.gens()) if k in indices and x != ring.variable("h")
    ]
    gens += [x for x in coordinates if x not in gens]
    degrees = list(_by_degree(gens, ring.one))
    images = [[derive(m) for m in monomials] for monomials in degrees]
    # A test modulo a prime excludes most cases without rational elimination.
    if not may_combine(list(chain(*images)), target):
        return None
    for most in range(1, len(degrees) + 1):
        coefficients, _ = solve_combination(list(chain(*images[:most])), target)
        if coefficients is not None:
            monomials = list(chain(*degrees[:most]))
            return sum((c * monomials[k] for k, c in coefficients.items()), ring.zero)
    return None


def _by_degree(gens: list[Poly], unity: Poly) -> Iterator[list[Poly]]:
    """Yield the monomials of degree 1, 2, …, as long as they are not too many in all."""
    for degree in range(1, _MOST_DEGREE):
        if math.comb(len(gens) + degree, degree) > _MOST_MONOMIALS:
            return
        chosen = combinations_with_replacement(gens, degree)
        yield [math.prod(factors, start=unity) for factors in chosen]
