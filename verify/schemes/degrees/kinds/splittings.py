"""Kicks and drifts in turn, for H = T(p) + V(q): each is a shear, and symplectic.

A kick moves p by −a h ∂V/∂q. The one block of its Jacobian that is neither 0 nor 1 is −a h Hess V,
and S of a shear is that block less its transpose, which is 0.
"""

from verify.algebra.series.jets import JetsInDegrees
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.splitting import all_times, shears_step
from verify.schemes.splitting_conditions import Splitting

KIND = Splitting


def build(coefficients: Splitting, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map of H = T(p) + V(q); InputError for another H."""
    parts = coefficients.parts
    times = all_times(parts, coefficients.times)
    sizes = [size for _, size in parts]
    field, exact = canonical_field(hamiltonian, *sizes, *times)
    if not field.separable:
        problem = "a splitting into kicks and drifts is for H = T(p) + V(q)"
        raise InputError("hamiltonian", hamiltonian.formula, problem)
    kinds = [kind for kind, _ in parts]
    step = shears_step(kinds, exact[: len(parts)], exact[len(parts) :])
    return CanonicalMap(hamiltonian, field, step, conditions=conditions(coefficients))


def conditions(coefficients: Splitting) -> tuple[Condition, ...]:
    """That kicks and drifts move by a gradient, whose Jacobian is symmetric, for all T and V."""
    jets = JetsInDegrees(("p1", "p2", "q1", "q2"), 2, separable=True)
    pairs = {"kick": ("q1", "q2"), "drift": ("p1", "p2")}
    found = []
    for kind in dict.fromkeys(kind for kind, _ in coefficients.parts):
        a, b = pairs[kind]
        gap = jets.diff(jets.first(a), b) - jets.diff(jets.first(b), a)
        found.append(
            Condition(f"every {kind} is a shear by a gradient", 0, str(gap), jets.vanishes(gap))
        )
    return tuple(found)
