"""Störmer–Verlet for H = T(p) + V(q): half a kick, a drift, half a kick.

p½ = p − (h/2) V'(q), q' = q + h T'(p½), p' = p½ − (h/2) V'(q'). Three shears, so det J ≡ 1.
"""

from fractions import Fraction

from verify.schemes.splitting import palindrome, splitting

_HALF = (Fraction(1, 2), Fraction(1))
ALIASES = ("verlet", "leapfrog", "leap-frog", "velocity-verlet", "kick-drift-kick", "strang")
SCHEME = splitting(
    "stormer-verlet",
    palindrome("kick", _HALF),
    order=2,
    symmetric=True,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.4 and VI.3",
)
