"""Suzuki's fourth-order composition of five Störmer–Verlet steps, for H = T(p) + V(q).

Steps s, s, 1 − 4s, s, s with s = 1/(4 − 4^(1/3)), which solves 4s³ + (1 − 4s)³ = 0. With R³ = 4 it
is (16 + 4R + R²)/60, since (4 − R)(16 + 4R + R²) = 64 − R³. No step is longer than 0.66 h.
"""

import sympy

from verify.schemes.splitting import compose, splitting

_R = sympy.cbrt(4)
_S = (16 + 4 * _R + _R**2) / 60
STEPS = (_S, _S, 1 - 4 * _S, _S, _S)
SCHEME = splitting(
    "suzuki4",
    compose("kick", STEPS),
    order=4,
    symmetric=True,
    source="Suzuki, Phys. Lett. A 146 (1990) 319–323; Hairer, Lubich, Wanner, Geometric "
    "Numerical Integration, II.4",
)
