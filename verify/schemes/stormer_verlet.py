"""Störmer–Verlet for H = T(p) + V(q): half a kick, a drift, half a kick.

p½ = p − (h/2) V'(q), q' = q + h T'(p½), p' = p½ − (h/2) V'(q'). Three shears, so det J ≡ 1.
"""

import sympy

from verify.generic import StageEquations
from verify.scheme import Scheme
from verify.splitting import shears

EXAMPLES = ("stormer-verlet",)
_PARTS = (("kick", sympy.S.Half), ("drift", sympy.S.One), ("kick", sympy.S.Half))


def make(name: str) -> Scheme | None:
    if name != EXAMPLES[0]:
        return None
    return Scheme(
        name=name,
        order=2,
        area_preserving=True,
        explicit=True,
        symmetric=True,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.4 and VI.3",
        build=lambda hamiltonian: shears(hamiltonian, name, _PARTS),
        generic=StageEquations.of_shears(_PARTS),
    )
