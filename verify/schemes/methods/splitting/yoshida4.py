"""Yoshida's fourth-order composition of Störmer–Verlet steps γh, (1 − 2γ)h, γh, H = T(p) + V(q).

γ = 1/(2 − 2^(1/3)) solves 2γ³ + (1 − 2γ)³ = 0, which removes the error of order h³. With
R = 2^(1/3) it is (4 + 2R + R²)/6, since (2 − R)(4 + 2R + R²) = 8 − R³; so it stays exact, an
element of the ring with R³ = 2. Neighbouring half kicks make one: seven shears, so det J ≡ 1.
"""

import sympy

from verify.schemes.splitting import compose, splitting

_R = sympy.cbrt(2)
_OUTER = (4 + 2 * _R + _R**2) / 6
STEPS = (_OUTER, 1 - 2 * _OUTER, _OUTER)
ALIASES = ("yoshida", "triple-jump4")
SCHEME = splitting(
    "yoshida4",
    compose("kick", STEPS),
    order=4,
    symmetric=True,
    source="Yoshida, Phys. Lett. A 150 (1990) 262–268; Hairer, Lubich, Wanner, "
    "Geometric Numerical Integration, II.4",
)
