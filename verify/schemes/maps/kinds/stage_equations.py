"""Stages that are solved one after the other: symplectic Euler for any H.

A stage moves p by −h a ∂H/∂q and q by h b ∂H/∂p, both at (P, Q) = (p + α(p' − p), q + β(q' − q)).
If a = b, dP∧dH_p + dQ∧dH_q = −d(dH) = 0 leaves dp'∧dq' − dp∧dq = (1 − α − β) δp∧δq, δ = d(z' − z):
so α + β = 1 suffices for a symplectic map, for every H. (Hairer, Lubich, Wanner, Geometric
Numerical Integration, VI.3.) In the plane less suffices; see `StageEquations.conditions`.
"""

from fractions import Fraction
from functools import lru_cache

from verify.algebra.formula import symbol
from verify.effort import limit_effort
from verify.hamiltonians.canonical_field import PlainField, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.maps.formula_map import map_from_expressions
from verify.schemes.maps.kinds import splittings
from verify.schemes.maps.step_map import StepMap


@lru_cache(maxsize=64)
def build(coefficients: StageEquations, hamiltonian: Hamiltonian, name: str) -> StepMap:
    """Return the map for any H.

    For H = T(p) + V(q), symplectic Euler is a kick and a drift. If ∂H/∂q is linear in p, it has a
    closed form in the plane.
    """
    field, _ = field_of(hamiltonian)
    if all(s.at_p == 1 and s.at_q == 0 for s in coefficients.stages):
        if field.separable:
            parts = [
                part for s in coefficients.stages for part in (("kick", s.kick), ("drift", s.drift))
            ]
            return splittings.build(Splitting(tuple(parts)), hamiltonian, name)
        if hamiltonian.planar and coefficients.stages == (_EULER,):
            linear = _linear_in_p(hamiltonian, field)
            if linear is not None:
                return linear
    stage_conditions = conditions(coefficients, field.degrees)
    return StepMap(
        hamiltonian, field, coefficients.changes, conditions=stage_conditions, implicit=True
    )


_EULER = Stage(kick=Fraction(1), drift=Fraction(1), at_p=Fraction(1))


def _linear_in_p(hamiltonian: Hamiltonian, field: PlainField) -> StepMap | None:
    """Return p' = p − h H_q/(1 + h H_pq), q' = q + h H_p(p', q); None unless H_q is linear in p."""
    ring, (force, speed) = field.ring, field.slopes
    # Linearity in p is decided exactly: the second derivative must be the zero function.
    mixed = ring.diff(force, "p")  # −H_pq
    if ring.vanishes(ring.diff(mixed, "p")) is not True:
        return None
    h_p, h_q, h_pq = map(ring.expression, (speed, -force, -mixed))
    p, q, h = map(symbol, "pqh")
    p_next = p - h * h_q / (1 + h * h_pq)
    with limit_effort("hamiltonian", str(hamiltonian.expression), "to compose its stages"):
        q_next = q + h * h_p.subs(p, p_next)
    return map_from_expressions(hamiltonian, (p_next, q_next))


def conditions(coefficients: StageEquations, degrees: int) -> tuple[Condition, ...]:
    """Return the conditions of all stages: det A = det B in the plane, else α + β = 1, a = b."""
    if degrees == 1:
        return coefficients.conditions()
    return tuple(map(_condition, coefficients.stages))


def _condition(stage: Stage) -> Condition:
    gap = stage.at_p + stage.at_q - 1
    same = stage.kick == stage.drift
    name = f"kick = drift = {stage.kick}, and its shares add up to 1"
    return Condition(name, 0, str(gap), bool(same and gap == 0))
