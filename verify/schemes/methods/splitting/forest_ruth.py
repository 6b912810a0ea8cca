"""The scheme of Forest and Ruth, fourth order, for H = T(p) + V(q): drifts first.

It is `yoshida4` with kicks and drifts exchanged: θ = 1/(2 − 2^(1/3)) = (4 + 2R + R²)/6, R³ = 2,
drifts θ/2, (1 − θ)/2, (1 − θ)/2, θ/2 and kicks θ, 1 − 2θ, θ.
"""

import sympy

from verify.schemes.splitting import palindrome, splitting

_R = sympy.cbrt(2)
_THETA = (4 + 2 * _R + _R**2) / 6
_HALF = (_THETA / 2, _THETA, (1 - _THETA) / 2, 1 - 2 * _THETA)
SCHEME = splitting(
    "forest-ruth",
    palindrome("drift", _HALF),
    order=4,
    symmetric=True,
    source="Forest, Ruth, Physica D 43 (1990) 105–117; Candy, Rozmus, J. Comput. Phys. 92 "
    "(1991) 230–256",
)
