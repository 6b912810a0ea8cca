"""Whether the leading coefficient of ΔJ is X·G, so that along an orbit it telescopes to [G]₀ᵀ.

For `lieη` the leading coefficient is L = −div(X^η f)/(η + 1)!, f = (−H_q, H_p), of h^(η+1).

Even η: it is X·G for every smooth H, with G = −1/(η+1)! Σ_{k=0}^{η} (−1)^k P_{η−k,k}, where
P_{a,b} = ∂(Xᵃp, X^b q)/∂(p, q). Proof: the two-forms [a, b] = d(Xᵃp)∧d(X^b q) + d(X^b p)∧d(Xᵃq)
are symmetric in a and b, and the Lie derivative along X commutes with d, so that
X[a, b] = [a+1, b] + [a, b+1]. In the alternating sum over a + b = η of X[a, b] all but the ends
cancel: X Σ (−1)^k [η−k, k] = [η+1, 0] + (−1)^η [0, η+1] = 2 [η+1, 0] for even η, and
[η+1, 0] = div(X^η f) dp∧dq. In the plane every two-form is F dp∧dq, and X(F dp∧dq) = (X F) dp∧dq
since the flow preserves dp∧dq. ∎

Odd η: it is not, for any smooth G, where H has an equilibrium with det Hess H ≠ 0. For X·G vanishes
where f does, and there div(X^η f) = tr A^(η+1) = 2 (−det Hess H)^((η+1)/2), A = f'. ∎
"""

import math
from collections.abc import Sequence
from typing import Protocol

from verify.ring import Poly


class Derivation(Protocol):
    """p and q with their derivatives along the flow: `verify.hamiltonian.VectorField` is one."""

    def along(self, name: str, most: int) -> Sequence[Poly]:
        """[y, X y, …, X^most y] of y = p or q."""

    def bracket(self, x: Poly, y: Poly) -> Poly:
        """∂(x, y)/∂(p, q)."""


def potential_of_lie(field: Derivation, eta: int) -> Poly:
    """G with X·G = L, the coefficient of h^(η+1) in ΔJ of `lieη`, for even η."""
    if eta % 2:
        raise ValueError("for odd η the leading coefficient does not telescope")
    p, q = field.along("p", eta), field.along("q", eta)
    total = sum((-1) ** k * field.bracket(p[eta - k], q[k]) for k in range(eta + 1))
    return total / -math.factorial(eta + 1)
