"""Explicit Runge–Kutta methods: stage by stage, each at t + c h where H depends on time."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap, Step
from verify.schemes.degrees.step_algebra import StepAlgebra
from verify.schemes.every_hamiltonian import RungeKutta

KIND = RungeKutta
Stage = tuple[list[Any], Fraction]  # a change of z, and that of t by h


def build(coefficients: RungeKutta, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    return CanonicalMap(hamiltonian, field, step(coefficients))


def conditions(_: RungeKutta) -> tuple[Condition, ...]:
    """None: no explicit method is symplectic for every H."""
    return ()


def step(coefficients: RungeKutta) -> Step:
    """How z' is made."""

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        places = range(algebra.size)

        def moved(weights: Sequence[Fraction], slopes: Sequence[list[Any]]) -> Stage:
            columns = [[slope[k] for slope in slopes] for k in places]
            own = [algebra.moved(algebra.nothing, weights, column) for column in columns]
            return own, sum(weights, Fraction(0))

        def slope(stage: Stage) -> list[Any]:
            return algebra.slopes(*stage, places)

        return coefficients.step(slope, moved)[0]

    return changes
