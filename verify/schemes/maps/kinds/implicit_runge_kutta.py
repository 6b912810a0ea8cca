"""Implicit Runge–Kutta methods: their maps, symplectic by coefficients, and their order for one H.

The unknowns are Z_i = Y_i − z, where Y_i is the point of stage i: they are O(h), so that their
rounding is smaller than that of Y_i by a factor h (Hairer, Nørsett, Wanner, Solving Ordinary
Differential Equations I, II.8, and II, IV.8). Z_i = h Σ a_ij f(z + Z_j), and z' = z + h Σ b_i f(z +
Z_i). Newton's method begins at Z_i = h c_i f(z). For a large h the equations may have several
solutions: the one that it finds is the map. If H depends on time, stage i is at t + c_i h, c_i =
Σ_j a_ij.

The condition b_i a_ij + b_j a_ji = b_i b_j for all i, j suffices for S = JᵀΩJ − Ω ≡ 0, for every H
in any number of degrees of freedom (Sanz-Serna 1988; Hairer, Lubich, Wanner, Geometric Numerical
Integration, theorem VI.4.3).

The order for one H needs no Taylor series of the map. Up to the order that the conditions on its
coefficients give, the map agrees with the exact flow for every H. At the next power of h they
differ by Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t), over the trees of as many vertices. If ball arithmetic
encloses this sum away from 0 at some point, the order for this H is the same. Only the derivatives
of H at that point are needed; to multiply out a series would take minutes for an involved H.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import islice

import flint

from verify.algebra.enclosure import enclose, enclose_defined, points
from verify.algebra.formula import symbol
from verify.algebra.power_series import Derivatives
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.canonical_field import CanonicalField, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.schemes.conditions.coloured_trees import symmetry
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.implicit_tableau import ImplicitTableau, implicit_step
from verify.schemes.conditions.tree_conditions import (
    MOST_ORDER,
    Differentials,
    TreeConditions,
    gaps_of,
)
from verify.schemes.maps.formula_map import map_from_expressions
from verify.schemes.maps.step_map import StepMap

_TESTED_POINTS = 8
_PRECISION = 192


def build(coefficients: TreeConditions, hamiltonian: Hamiltonian, name: str = "") -> StepMap:
    """Return the map for any H."""
    return implicit_map(hamiltonian, coefficients.tableau)


@lru_cache(maxsize=64)
def implicit_map(hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> StepMap:
    """Return the map: in closed form for a quadratic H in the plane, else by equations."""
    closed_form = None
    if hamiltonian.planar and not hamiltonian.time_dependent:
        closed_form = _linear(hamiltonian, tableau)
    return closed_form or by_equations(hamiltonian, tableau)


def by_equations(hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> StepMap:
    """Return the map by its equations, for any H."""
    count = tableau.stages
    numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
    field, exact = field_of(hamiltonian, *numbers)
    rows = [exact[count * i : count * (i + 1)] for i in range(count)]
    clocks = [sum(row, field.ring.zero) for row in rows]

    def known_order() -> int | None:
        """Return the order by rooted trees, for an H in the plane without time; else None."""
        if not isinstance(field, CanonicalField) or not hamiltonian.planar or field.timed:
            return None
        return order_of(tableau, field)

    return StepMap(
        hamiltonian,
        field,
        implicit_step(rows, exact[count * count :], clocks),
        conditions=tableau.area_conditions(),
        known_order=known_order,
        implicit=True,
        keeps_quadratic=True,  # Hairer, Lubich, Wanner, theorem IV.2.2
    )


def conditions(coefficients: TreeConditions, degrees: int) -> tuple[Condition, ...]:
    """Return the conditions b_i a_ij + b_j a_ji = b_i b_j."""
    return coefficients.tableau.area_conditions()


# -- a quadratic H in the plane -------------------------------------------------------------------


def _linear(hamiltonian: Hamiltonian, tableau: ImplicitTableau) -> StepMap | None:
    """Return the closed form for a quadratic H; None for another.

    f(z + d) = f(z) + M d with M² = −D, D = det Hess H, and z' = z + h ρ(hM) f(z) with
    ρ(μ) = (R(μ) − 1)/μ, R the method's stability function (Hairer, Wanner, II, IV.3). Multiplied
    above and below by its denominator at −μ, ρ has an even denominator γ: ρ(hM) = (α + β h M)/γ,
    where α, β and γ are polynomials in μ² = −h² D.
    """
    p, q, h = map(symbol, "pqh")
    field, _ = field_of(hamiltonian)
    ring, (u, v) = field.ring, field.slopes
    matrix = [x for slope in field.slopes for x in field.gradient(slope)]
    if any(ring.vanishes(ring.diff(x, n)) is not True for x in matrix for n in field.names):
        return None
    u, v, u_p, u_q, v_p, v_q = map(ring.expression, (u, v, *matrix))
    # μ² = −h² D by Cayley and Hamilton, as the trace of M is 0.
    square = -(h**2) * (u_p * v_q - u_q * v_p)
    alpha, beta, gamma = (x.subs(_square(), square) for x in _rational_function(tableau))
    more_u, more_v = u_p * u + u_q * v, v_p * u + v_q * v
    p_next = p + h * (alpha * u + beta * h * more_u) / gamma
    q_next = q + h * (alpha * v + beta * h * more_v) / gamma
    return map_from_expressions(hamiltonian, (p_next, q_next))


def _square() -> sympy.Symbol:
    return sympy.Symbol("square")


@lru_cache(maxsize=64)
def _rational_function(tableau: ImplicitTableau) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """Return α, β and γ as polynomials in μ²; see `_linear`."""
    count, mu = tableau.stages, sympy.Symbol("mu")  # an eigenvalue of hM
    a, b = sympy.Matrix(tableau.rows), sympy.Matrix([tableau.weights])
    pencil = sympy.eye(count) - mu * a
    below = sympy.expand(pencil.det(method="berkowitz"))
    above = sympy.expand((pencil + mu * sympy.ones(count, 1) * b).det(method="berkowitz"))
    rho = sympy.expand(sympy.expand(above - below) / mu)
    # Multiplied above and below by the denominator at −μ: the new denominator is even in μ.
    below_mirrored = below.subs(mu, -mu)
    numerator, even = (sympy.Poly(sympy.expand(x * below_mirrored), mu) for x in (rho, below))
    parts = [sympy.S.Zero] * 2
    for (n,), c in numerator.terms():
        parts[n % 2] += c * _square() ** (n // 2)
    gamma = sum((c * _square() ** (n // 2) for (n,), c in even.terms()), sympy.S.Zero)
    return parts[0], parts[1], gamma


# -- the order for one H --------------------------------------------------------------------------


def order_of(tableau: ImplicitTableau, field: CanonicalField) -> int | None:
    """Return the order for this H; None if no point decides it."""
    for order in range(1, MOST_ORDER + 1):
        gaps = gaps_of(tableau, order)
        decisions = [tableau.numbers.ring.decide(x).zero for x in gaps.values()]
        if None in decisions:
            return None
        if False in decisions:
            return order - 1 if _differ(tableau, field, order) else None
    return None


def _differ(tableau: ImplicitTableau, field: CanonicalField, order: int) -> bool:
    """Return True if balls show at a point that map and flow differ at h^order."""
    ring = tableau.numbers.ring
    names = [n for n in field.ring.variables if n != "h"]
    with working_precision(_PRECISION):
        shares = {
            tree: enclose_defined(ring, gap, {}, _PRECISION) / symmetry(tree)
            for tree, gap in gaps_of(tableau, order).items()
        }
        # One point with a nonzero difference proves it; if none shows one, nothing is concluded.
        for point in islice(points(names), _TESTED_POINTS):
            jets = _JetsAtPoint(field, point)
            differentials = Differentials(jets)
            total = [flint.arb(0)] * 2
            for tree, share in shares.items():
                total = [
                    x + share * y
                    for x, y in zip(total, differentials.differential(tree), strict=True)
                ]
            if jets.is_defined and any(x.is_finite() and not x.contains(0) for x in total):
                return True
    return False


class _JetsAtPoint:
    """The derivatives of H at a point as balls; they take the place of the jets."""

    def __init__(self, field: CanonicalField, point: Mapping[str, Fraction]) -> None:
        self.field, self.point, self.is_defined = field, point, True
        self.zero = flint.arb(0)
        self._of_p, self._of_q = (Derivatives(field.ring, x) for x in field.gradient(field.energy))
        self._cache: dict[tuple[int, int], flint.arb] = {}

    def h(self, i: int, j: int, k: int = 0) -> flint.arb:
        """Return H_ijk at the point; NaN if it may be undefined. H must not depend on time."""
        if k:
            return self.zero
        if (i, j) not in self._cache:
            x = self._of_p.partial(i - 1, j) if i else self._of_q.partial(0, j - 1)
            value = enclose(self.field.ring, x, self.point, _PRECISION)
            self.is_defined = self.is_defined and value is not None
            self._cache[i, j] = flint.arb.nan() if value is None else value
        return self._cache[i, j]
