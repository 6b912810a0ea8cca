"""Symplectic Euler for any H: p' = p − h H_q(p', q), q' = q + h H_p(p', q).

Where H_q is linear in p, as for H = T(p) + p b(q) + V(q), the first equation gives
p' = p − h H_q(p, q)/(1 + h H_pq(q)). For H = T(p) + V(q) it is `symplectic-euler`. Elsewhere the
equation is solved for the change of p.

If H depends on time and is not of the form T(p, t) + V(q, t), both derivatives are taken at t: they
are those of one generating function, h H(p', q, t), so that det J ≡ 1.
"""

from fractions import Fraction

from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.scheme import Scheme

_ONE = Fraction(1)
SCHEME = Scheme(
    name="implicit-symplectic-euler",
    order=1,
    area_preserving=True,
    explicit=False,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2 and VI.3",
    every_h=StageEquations((Stage(kick=_ONE, drift=_ONE, at_p=_ONE),)),
)
