"""Stages that are solved for, one after the other: implicit midpoint, symplectic Euler of any H.

A stage moves p by −h a ∂H/∂q and q by h b ∂H/∂p, both taken at (p + α(p' − p), q + β(q' − q)). With
a = b, dP∧dH_p + dQ∧dH_q = −d(dH) = 0 leaves dp'∧dq' − dp∧dq = (1 − α − β) δp∧δq, δ = d(z' − z): so
α + β = 1 suffices for a map that is symplectic, for every H. (Hairer, Lubich, Wanner, Geometric
Numerical Integration, VI.3.)
"""

from fractions import Fraction

import sympy

from verify.algebra.conditions import Condition
from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import Flow, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State, slopes_at, start_of
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
        hamiltonian,
        field,
        lambda most: series_over(field, coefficients, most),
        conditions=conditions(coefficients),
        implicit=True,
    )


def conditions(coefficients: StageEquations) -> tuple[Condition, ...]:
    """Those of each stage; see the module's text."""
    return tuple(map(_condition, coefficients.stages))


def series_over(field: Flow, coefficients: StageEquations, most: int) -> State:
    """z' up to h^most, by iteration: each one makes one power of h more right."""
    ring, n = field.ring, field.degrees
    before = [Series.of(ring, [], most)] * (2 * n)
    for stage in coefficients.stages:
        changes = before
        shares = [stage.at_p] * n + [stage.at_q] * n
        weights = [stage.kick] * n + [stage.drift] * n
        clock = Series.of(ring, [ring.zero, ring.constant(_time(stage))], most)
        for _ in range(most):
            at = [x + (y - x).times(c) for x, y, c in zip(before, changes, shares, strict=True)]
            slopes = slopes_at(field, at, clock, range(2 * n))
            moved = (s.times(w).shifted(1) for s, w in zip(slopes, weights, strict=True))
            changes = [x + y for x, y in zip(before, moved, strict=True)]
        before = changes
    return tuple(x + y for x, y in zip(start_of(field, most), before, strict=True))


def _time(stage: Stage) -> Fraction:
    """When H is read in it, as a part of h: t goes with q."""
    return stage.at_q


def _condition(stage: Stage) -> Condition:
    gap = stage.at_p + stage.at_q - 1
    same = stage.kick == stage.drift
    name = f"kick = drift = {stage.kick}, and its shares add up to 1"
    return Condition(name, 0, str(gap), bool(same and gap == 0))
