"""Kicks and drifts in turn, for H = T(p) + V(q): each is a shear, and symplectic.

A kick moves p by −a h ∂V/∂q. The one block of its Jacobian that is neither 0 nor the identity is
−a h Hess V. S = JᵀΩJ − Ω of a shear is the difference of that block and its transpose, which is 0.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

from verify.algebra.jets import JetsInDegrees
from verify.algebra.ring import Poly
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import Step, StepAlgebra


def build(coefficients: Splitting, hamiltonian: Hamiltonian, name: str) -> StepMap:
    """Return the map of H = T(p) + V(q), or T(p, t) + V(q, t); InputError for another H."""
    parts = coefficients.raw_parts
    field, sizes, times = _with_numbers(hamiltonian, coefficients)
    if not field.separable:
        formula = str(hamiltonian.expression)
        raise InputError("hamiltonian", formula, f"{name} is explicit only for H = T(p) + V(q)")
    step = _shears([kind for kind, _ in parts], sizes, times)
    return StepMap(
        hamiltonian, field, step, conditions=conditions(coefficients, hamiltonian.degrees)
    )


def _with_numbers(
    hamiltonian: Hamiltonian, coefficients: Splitting
) -> tuple[CanonicalField, Sequence[Poly], Sequence[Poly]]:
    """Return the field of H, and the sizes and times of the parts in its ring."""
    parts = coefficients.raw_parts
    is_timed = hamiltonian.time_dependent
    rational = [size for _, size in parts if isinstance(size, Fraction)]
    # Rational sizes need no embedding: then the cached field of H serves, which schemes share.
    if len(rational) == len(parts) and not is_timed:
        field = canonical_field(hamiltonian)[0]
        sizes = [field.ring.constant(size) for size in rational]
        return field, sizes, [field.ring.zero] * len(parts)
    times = coefficients.all_times if is_timed else ()
    field, numbers = canonical_field(hamiltonian, *(x for _, x in coefficients.parts), *times)
    sizes = numbers[: len(parts)]
    return field, sizes, numbers[len(parts) :] or [field.ring.zero] * len(parts)


def _shears(kinds: Sequence[str], sizes: Sequence[Poly], times: Sequence[Poly]) -> Step:
    """Return the step of kicks and drifts with these sizes and times in the ring of H's field."""

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        n = algebra.size // 2
        moves = {"kick": range(n), "drift": range(n, 2 * n)}
        result = [algebra.nothing] * algebra.size
        for kind, size, time in zip(kinds, sizes, times, strict=True):
            result = algebra.shear(result, size, time, moves[kind])
        return result

    return changes


def conditions(coefficients: Splitting, degrees: int) -> tuple[Condition, ...]:
    """Return the conditions that kicks and drifts move by gradients, for all T and V.

    The Jacobian of a gradient is symmetric.
    """
    return _gradient_conditions(tuple(dict.fromkeys(kind for kind, _ in coefficients.raw_parts)))


@lru_cache(maxsize=4)
def _gradient_conditions(kinds: tuple[str, ...]) -> tuple[Condition, ...]:
    jets = JetsInDegrees(("p1", "p2", "q1", "q2"), 2, separable=True)
    pairs = {"kick": ("q1", "q2"), "drift": ("p1", "p2")}
    gradient_conditions = []
    for kind in kinds:
        a, b = pairs[kind]
        gap = jets.diff(jets.first(a), b) - jets.diff(jets.first(b), a)
        gradient_conditions.append(
            Condition(f"every {kind} is a shear by a gradient", 0, str(gap), jets.vanishes(gap))
        )
    return tuple(gradient_conditions)
