"""Symplectic Euler (Eq. 24, 32): p' = p − h V'(q), q' = q + h T'(p'), for H = T(p) + V(q).

Each of its two substeps is a shear, so det J ≡ 1. For an H that is not separable the scheme is
implicit; this file holds the explicit one and says so.
"""

import sympy

from verify.generic import StageEquations
from verify.scheme import Scheme
from verify.splitting import shears

EXAMPLES = ("symplectic-euler",)
PARTS = (("kick", sympy.S.One), ("drift", sympy.S.One))


def make(name: str) -> Scheme | None:
    if name != EXAMPLES[0]:
        return None
    return Scheme(
        name=name,
        order=1,
        area_preserving=True,
        explicit=True,
        symmetric=False,
        source="Eq. 24, 32; Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2",
        build=lambda hamiltonian: shears(hamiltonian, name, PARTS),
        generic=StageEquations.of_shears(PARTS),
    )
