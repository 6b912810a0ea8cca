"""Order 6 by the triple jump: steps θh, (1 − 2θ)h, θh of `yoshida4`, for H = T(p) + V(q).

θ = 1/(2 − 2^(1/5)) solves 2θ⁵ + (1 − 2θ)⁵ = 0, which removes the error of order h⁵ of a symmetric
scheme of order 4. With F⁵ = 2 it is (16 + 8F + 4F² + 2F³ + F⁴)/30, since (2 − F) times that sum is
32 − F⁵. Nine Störmer–Verlet steps, or 19 shears, with exact coefficients in Q(2^(1/15)).
"""

import sympy

from verify.schemes.methods.splitting.yoshida4 import STEPS
from verify.schemes.splitting import compose, splitting

_F = sympy.root(2, 5)
_THETA = (16 + 8 * _F + 4 * _F**2 + 2 * _F**3 + _F**4) / 30
_STEPS = tuple(outer * inner for outer in (_THETA, 1 - 2 * _THETA, _THETA) for inner in STEPS)
SCHEME = splitting(
    "triple-jump6",
    compose("kick", _STEPS),
    order=6,
    symmetric=True,
    source="Creutz, Gocksch, Phys. Rev. Lett. 63 (1989) 9–12; Hairer, Lubich, Wanner, "
    "Geometric Numerical Integration, II.4",
)
