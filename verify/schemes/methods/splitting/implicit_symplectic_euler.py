"""Symplectic Euler for any H: p' = p − h H_q(p', q), q' = q + h H_p(p', q).

Where H_q is linear in p, as for H = T(p) + p b(q) + V(q), the first equation gives
p' = p − h H_q(p, q)/(1 + h H_pq(q)). For H = T(p) + V(q) it is `symplectic-euler`. Elsewhere the
equation is solved for the change of p.

Where H depends on time and is no T(p, t) + V(q, t), both derivatives are taken at t: of one time
they are those of one generating function, h H(p', q, t), so that det J ≡ 1.
"""

from fractions import Fraction
from functools import lru_cache

from verify.algebra.implicit_unknowns import define, unknowns
from verify.algebra.ring import Poly
from verify.algebra.symbols import H_STEP, P, Q
from verify.effort import limited
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.vector_field import VectorField
from verify.schemes.every_hamiltonian import Stage, StageEquations
from verify.schemes.methods.splitting.symplectic_euler import PARTS
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import shears
from verify.schemes.stages import Stages
from verify.schemes.step_algebra import series_in_plane
from verify.schemes.step_map import StepMap, Substep

_ONE = Fraction(1)
_NAMES = 20
_NAME = "implicit-symplectic-euler"
_EQUATIONS = StageEquations((Stage(kick=_ONE, drift=_ONE, at_p=_ONE),))


@lru_cache(maxsize=64)
def implicit_euler_map(hamiltonian: Hamiltonian) -> StepMap:
    """The map: in closed form where H_q is linear in p, else by its equations."""
    field, _ = hamiltonian.field()
    ring = field.ring
    if field.separable():
        return shears(hamiltonian, _NAME, PARTS)
    mixed = ring.diff(field.h_q, "p")
    if ring.decide(ring.diff(mixed, "p")).zero is not True:
        return _by_equations(hamiltonian, field)
    h_p, h_q, h_pq = map(ring.expression, (field.h_p, field.h_q, mixed))
    p_next = P - H_STEP * h_q / (1 + H_STEP * h_pq)
    with limited("hamiltonian", str(hamiltonian.expression), "to compose its stages"):
        q_next = Q + H_STEP * h_p.subs(P, p_next)
    return StepMap.from_expressions(hamiltonian, p_next, q_next)


def _by_equations(hamiltonian: Hamiltonian, field: VectorField) -> StepMap:
    stages = Stages(field, 1, _NAMES)
    ring, (p, q, *time) = stages.ring, stages.start
    h = ring.variable("h")
    change = unknowns(ring, 1)
    at = stages.at(stages.named((p + change[0], q, *time)))

    def named_at_stage(x: Poly) -> Poly:
        return ring.named(at(x))

    h_p, h_q = named_at_stage(field.h_p), named_at_stage(field.h_q)
    h_pq, h_qq = (named_at_stage(field.ring.diff(field.h_q, name)) for name in ("p", "q"))
    define(
        ring,
        change,
        residuals=[change[0] + h * h_q],
        matrix=[[1 + h * h_pq]],
        partials={"p": lambda: [h * h_pq], "q": lambda: [h * h_qq], "h": lambda: [h_q]},
        starts=[-h * stages.field.h_q],
        added_to=[p],
    )
    step = Substep(stages.field, p - h * h_q, q + h * h_p, _EQUATIONS.conditions())
    return StepMap(
        hamiltonian, (step,), lambda most: series_in_plane(field, _EQUATIONS.changes, most)
    )


SCHEME = Scheme(
    name=_NAME,
    order=1,
    area_preserving=True,
    explicit=False,
    symmetric=False,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2 and VI.3",
    build=implicit_euler_map,
    every_h=_EQUATIONS,
)
