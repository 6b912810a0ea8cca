"""McLachlan and Atela's optimal scheme of order 2 with two stages, for H = T(p) + V(q).

Kicks b and drifts a in turn, b₁, a₁, b₂, a₂, with a₁ = √2/2 = b₂, a₂ = 1 − √2/2 = b₁. Of all
schemes of order 2 with two stages it has the smallest errors of order 3; it is not symmetric.
"""

import sympy

from verify.schemes.splitting import alternating, splitting

_A = sympy.sqrt(2) / 2
_SIZES = (1 - _A, _A, _A, 1 - _A)
SCHEME = splitting(
    "mclachlan-atela2",
    alternating("kick", _SIZES),
    order=2,
    symmetric=False,
    source="McLachlan, Atela, Nonlinearity 5 (1992) 541–562",
)
