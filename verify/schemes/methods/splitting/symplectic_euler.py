"""Symplectic Euler (Eq. 24, 32): p' = p − h V'(q), q' = q + h T'(p'), for H = T(p) + V(q).

Each of its two substeps is a shear, so det J ≡ 1. For an H that is not separable see
`implicit-symplectic-euler`.
"""

from fractions import Fraction

from verify.schemes.splitting import alternating, splitting

PARTS = alternating("kick", (Fraction(1), Fraction(1)))
ALIASES = ("semi-implicit-euler", "euler-cromer")
SCHEME = splitting(
    "symplectic-euler",
    PARTS,
    order=1,
    symmetric=False,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2",
)
