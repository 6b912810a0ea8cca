"""Störmer–Verlet for H = T(p) + V(q): half a kick, a drift, half a kick.

p½ = p − (h/2) V'(q), q' = q + h T'(p½), p' = p½ − (h/2) V'(q'). Three shears, so det J ≡ 1.
"""

import sympy

from verify.schemes.splitting import palindrome, splitting

_HALF = (sympy.S.Half, sympy.S.One)
ALIASES = ("verlet", "leapfrog", "leap-frog", "velocity-verlet", "kick-drift-kick", "strang")
SCHEME = splitting(
    "stormer-verlet",
    palindrome("kick", _HALF),
    order=2,
    symmetric=True,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.4 and VI.3",
)
