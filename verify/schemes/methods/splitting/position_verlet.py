"""Störmer–Verlet in its other form, for H = T(p) + V(q): half a drift, a kick, half a drift.

q½ = q + (h/2) T'(p), p' = p − h V'(q½), q' = q½ + (h/2) T'(p').
"""

from fractions import Fraction

from verify.schemes.splitting import palindrome, splitting

_HALF = (Fraction(1, 2), Fraction(1))
ALIASES = ("drift-kick-drift",)
SCHEME = splitting(
    "position-verlet",
    palindrome("drift", _HALF),
    order=2,
    symmetric=True,
    source="Tuckerman, Berne, Martyna, J. Chem. Phys. 97 (1992) 1990–2001; Hairer, Lubich, "
    "Wanner, Geometric Numerical Integration, I.1.4",
)
