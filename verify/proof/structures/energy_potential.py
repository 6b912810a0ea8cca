"""The potential G of the energy's error for lieη of even η: the leading coefficient is X·G.

H is constant along the flow, and z' misses it by −h^(η+1)/(η+1)! X^(η+1)z + O(h^(η+2)). So
H(z') − H(z) begins with −h^(η+1)/(η+1)! dH·X^(η+1)z = h^(η+1)/(η+1)! ω(Xz, X^(η+1)z), ω = dp∧dq.
With G = 1/(η+1)! Σ_j (−1)^(j−1) ω(X^j z, X^(η+1−j) z), j = 1 … η/2, the terms of X·G cancel in
pairs, but for the first, which is that coefficient, and the last, ω(v, v) = 0. ∎
"""

import math
from fractions import Fraction

from verify.algebra.ring import Poly
from verify.hamiltonians.canonical_field import CanonicalField


def energy_potential(flow: CanonicalField, eta: int) -> Poly:
    """Return G, in the ring of the flow; `eta` is even."""
    ring, total = flow.ring, flow.ring.zero
    for j in range(1, eta // 2 + 1):
        term = _omega(flow, flow.power(j), flow.power(eta + 1 - j))
        total = total + term if j % 2 else total - term
    return ring.reduce(total * ring.constant(Fraction(1, math.factorial(eta + 1))))


def _omega(flow: CanonicalField, u: tuple[Poly, ...], v: tuple[Poly, ...]) -> Poly:
    """Return Σ u_p v_q − u_q v_p."""
    n, total = flow.degrees, flow.ring.zero
    for k in range(n):
        total += u[k] * v[n + k] - u[n + k] * v[k]
    return total
