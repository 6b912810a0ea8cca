"""Stages that are solved for, one after the other: implicit midpoint, symplectic Euler of any H.

A stage moves p by −h a ∂H/∂q and q by h b ∂H/∂p, both taken at (p + α(p' − p), q + β(q' − q)). With
a = b, dP∧dH_p + dQ∧dH_q = −d(dH) = 0 leaves dp'∧dq' − dp∧dq = (1 − α − β) δp∧δq, δ = d(z' − z): so
α + β = 1 suffices for a map that is symplectic, for every H. (Hairer, Lubich, Wanner, Geometric
Numerical Integration, VI.3.)
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import sympy

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap, Step
from verify.schemes.degrees.kinds import splittings
from verify.schemes.degrees.step_algebra import StepAlgebra
from verify.schemes.every_hamiltonian import Stage, StageEquations
from verify.schemes.splitting_conditions import Splitting

KIND = StageEquations
_ONE = Fraction(1)


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
        step(coefficients),
        conditions=conditions(coefficients),
        implicit=True,
    )


def conditions(coefficients: StageEquations) -> tuple[Condition, ...]:
    """Those of each stage; see the module's text."""
    return tuple(map(_condition, coefficients.stages))


def step(coefficients: StageEquations) -> Step:
    """How z' is made: of each stage the change that it makes is solved for."""

    def changes(outer: StepAlgebra[Any]) -> list[Any]:
        found = [outer.nothing] * outer.size
        for stage in coefficients.stages:
            change = outer.solved(outer.size, _right(stage, found))
            found = [outer.between(x, y, _ONE) for x, y in zip(found, change, strict=True)]
        return found

    return changes


def _right(
    stage: Stage, before: Sequence[Any]
) -> Callable[[StepAlgebra[Any], Sequence[Any]], list[Any]]:
    """h times the slopes that a stage takes, at a share of the change that they make."""

    def right(algebra: StepAlgebra[Any], change: Sequence[Any]) -> list[Any]:
        n = algebra.size // 2
        shares, weights = [stage.at_p] * n + [stage.at_q] * n, [stage.kick] * n + [stage.drift] * n
        at = [algebra.between(*each) for each in zip(before, change, shares, strict=True)]
        slopes = algebra.slopes(at, stage.at_q, range(2 * n))  # t goes with q
        each = zip(weights, slopes, strict=True)
        return [algebra.moved(algebra.nothing, [w], [slope]) for w, slope in each]

    return right


def _condition(stage: Stage) -> Condition:
    gap = stage.at_p + stage.at_q - 1
    same = stage.kick == stage.drift
    name = f"kick = drift = {stage.kick}, and its shares add up to 1"
    return Condition(name, 0, str(gap), bool(same and gap == 0))
