"""Symplectic Euler for any H: p' = p − h H_q(p', q), q' = q + h H_p(p', q), where it can be solved.

Where H_q is linear in p, as for H = T(p) + p b(q) + V(q), the first equation gives
p' = p − h H_q(p, q)/(1 + h H_pq(q)). For H = T(p) + V(q) it is `symplectic-euler`.
"""

from fractions import Fraction

from verify.errors import InputError
from verify.generic import Stage, StageEquations
from verify.hamiltonian import Hamiltonian
from verify.scheme import Scheme
from verify.schemes.symplectic_euler import PARTS
from verify.splitting import shears
from verify.step_map import H_STEP, P, Q, StepMap

_ONE = Fraction(1)
EXAMPLES = ("implicit-symplectic-euler",)


def make(name: str) -> Scheme | None:
    if name != EXAMPLES[0]:
        return None
    return Scheme(
        name=name,
        order=1,
        area_preserving=True,
        explicit=False,
        symmetric=False,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2 and VI.3",
        build=implicit_euler_map,
        generic=StageEquations((Stage(kick=_ONE, drift=_ONE, at_p=_ONE),)),
    )


def implicit_euler_map(hamiltonian: Hamiltonian) -> StepMap:
    """The solved map; InputError unless H_q is linear in p."""
    field, _ = hamiltonian.field()
    ring = field.ring
    if field.separable():
        return shears(hamiltonian, EXAMPLES[0], PARTS)
    mixed = ring.diff(field.h_q, "p")
    if ring.decide(ring.diff(mixed, "p")).zero is not True:
        raise InputError(
            "hamiltonian",
            str(hamiltonian.expression),
            "implicit-symplectic-euler is implicit; for one H it is solved only where H_q is "
            "linear in p, and --every-hamiltonian proves it for all",
        )
    h_p, h_q, h_pq = map(ring.expression, (field.h_p, field.h_q, mixed))
    p_next = P - H_STEP * h_q / (1 + H_STEP * h_pq)
    q_next = Q + H_STEP * h_p.subs(P, p_next)
    return StepMap.from_expressions(hamiltonian, p_next, q_next)
