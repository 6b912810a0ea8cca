"""Stages that are solved for, one after the other: implicit midpoint, symplectic Euler of any H.

A stage moves p by −h a ∂H/∂q and q by h b ∂H/∂p, both taken at (p + α(p' − p), q + β(q' − q)). With
a = b, dP∧dH_p + dQ∧dH_q = −d(dH) = 0 leaves dp'∧dq' − dp∧dq = (1 − α − β) δp∧δq, δ = d(z' − z): so
α + β = 1 suffices for a map that is symplectic, for every H. (Hairer, Lubich, Wanner, Geometric
Numerical Integration, VI.3.)
"""

import sympy

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.degrees.kinds import splittings
from verify.schemes.every_hamiltonian import Stage, StageEquations
from verify.schemes.splitting_conditions import Splitting

KIND = StageEquations


def build(coefficients: StageEquations, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H. Where H = T(p) + V(q), symplectic Euler is its kick and its drift."""
    field, _ = canonical_field(hamiltonian)
    if field.separable and all(s.at_p == 1 and s.at_q == 0 for s in coefficients.stages):
        parts = [
            part for s in coefficients.stages for part in (("kick", s.kick), ("drift", s.drift))
        ]
        return splittings.build(
            Splitting(tuple((kind, sympy.Rational(size)) for kind, size in parts)), hamiltonian
        )
    return CanonicalMap(
        hamiltonian, field, coefficients.changes, conditions=conditions(coefficients), implicit=True
    )


def conditions(coefficients: StageEquations) -> tuple[Condition, ...]:
    """Those of each stage; see the module's text."""
    return tuple(map(_condition, coefficients.stages))


def _condition(stage: Stage) -> Condition:
    gap = stage.at_p + stage.at_q - 1
    same = stage.kick == stage.drift
    name = f"kick = drift = {stage.kick}, and its shares add up to 1"
    return Condition(name, 0, str(gap), bool(same and gap == 0))
