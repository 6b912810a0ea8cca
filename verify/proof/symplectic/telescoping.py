"""Whether the leading coefficient of lieη's S is the Lie derivative of a 2-form, and telescopes.

Along an orbit M_kᵀ (S_k/h) M_k then adds up to the difference of that form at the two ends. Let
[a, b] = Σ_i d(Xᵃp_i)∧d(X^b q_i). The Lie derivative L commutes with d, so L[a, b] = [a+1, b] +
[a, b+1], and L[0, 0] = LΩ = 0. S begins with −h^(η+1)/(η+1)! ([η+1, 0] + [0, η+1]).

Even η: it is Lβ, β = −1/(η+1)! Σ_k (−1)^k [η−k, k], k = 0 … η, in whose alternating sum all but
the ends cancel.

Where f vanishes, L of a form B is AᵀB + BA, A = f'. From AᵀΩ = −ΩA, tr Ω⁻¹(AᵀB + BA) = 0, for any
B. So where that trace of a coefficient of S, which is twice its divergence, is not 0 at an
equilibrium, it is no Lie derivative of a smooth form.
"""

import math
from fractions import Fraction

import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.ring import Poly
from verify.algebra.substitution import substitute
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, Flow
from verify.schemes.degrees.two_form import TwoForm, lie_derivative, wedge


def potential_of_lie(flow: Flow, eta: int) -> TwoForm:
    """β of lieη, for even η."""
    if eta % 2:
        raise ValueError("for odd η the leading coefficient does not telescope")
    n, ring = flow.degrees, flow.ring
    rows = [[flow.gradient(x) for x in flow.power(k)] for k in range(eta + 1)]
    factor = ring.constant(Fraction(-1, math.factorial(eta + 1)))

    def entry(a: int, b: int) -> Poly:
        total = ring.zero
        for k in range(eta + 1):
            both = (wedge(rows[eta - k][i], rows[k][n + i], a, b) for i in range(n))
            total += (-1) ** k * sum(both, ring.zero)
        return factor * total

    return TwoForm.of(ring, flow.names, entry)


def telescopes_of_lie(flow: CanonicalField, eta: int, leading: TwoForm) -> tuple[bool | None, str]:
    """Whether the leading coefficient of lieη's S is a Lie derivative, and β as a formula.

    None where neither is found.
    """
    if eta % 2 == 0:
        potential = potential_of_lie(flow, eta)
        gap, _ = (lie_derivative(flow, potential) - leading).decide()
        return (True, potential.text) if gap.zero is True else (None, "")
    return (False if _shown_at_rest(flow, leading) else None), ""


def _shown_at_rest(flow: CanonicalField, leading: TwoForm) -> bool:
    """Whether the origin is an equilibrium at which the divergence is not 0."""
    ring = flow.ring
    if flow.timed:  # f vanishes at all times where D of what does not depend on t is X of it
        return False
    origin = {symbol(name): sympy.S.Zero for name in flow.names}
    elements = [*flow.slopes, leading.divergence]
    try:
        there = [substitute(ring.expression(x), origin, "z0") for x in elements]
        constants, found = embed(there, [n for n in ring.variables if n not in flow.names])
    except (InputError, ArithmeticError, KeyError):
        return False
    *slopes, divergence = (constants.vanishes(x) for x in found)
    return all(x is True for x in slopes) and divergence is False
