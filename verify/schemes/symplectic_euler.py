"""Symplectic Euler (Eq. 24, 32): p' = p − h V'(q), q' = q + h T'(p'), for H = T(p) + V(q).

Each of its two substeps is a shear, so det J ≡ 1. For an H that is not separable the scheme is
implicit; this file holds the explicit one and says so.
"""

from fractions import Fraction

from verify.errors import InputError
from verify.generic import Stage, Stages
from verify.hamiltonian import Hamiltonian
from verify.scheme import Scheme
from verify.step_map import StepMap, Substep

_ONE = Fraction(1)
EXAMPLES = ("symplectic-euler",)


def make(name: str) -> Scheme | None:
    if name != EXAMPLES[0]:
        return None
    return Scheme(
        name=name,
        order=1,
        area_preserving=True,
        explicit=True,
        source="Eq. 24, 32; Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2",
        build=symplectic_euler_map,
        generic=Stages((Stage(kick=_ONE, drift=Fraction(0)), Stage(Fraction(0), drift=_ONE)), True),
    )


def symplectic_euler_map(hamiltonian: Hamiltonian) -> StepMap:
    """Two shears; InputError unless H = T(p) + V(q)."""
    field, _ = hamiltonian.field()
    ring = field.ring
    if not field.separable():
        raise InputError(
            "hamiltonian",
            str(hamiltonian.expression),
            "symplectic-euler is explicit only for H = T(p) + V(q)",
        )
    p, q, h = (ring.variable(name) for name in ("p", "q", "h"))
    kick = Substep(field, p - h * field.h_q, q)
    drift = Substep(field, p, q + h * field.h_p)
    return StepMap(hamiltonian, (kick, drift))
