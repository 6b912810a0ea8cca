"""Explicit Runge–Kutta methods: stage by stage, each at t + c h where H depends on time."""

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.every_hamiltonian import RungeKutta

KIND = RungeKutta


def build(coefficients: RungeKutta, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    return CanonicalMap(hamiltonian, field, coefficients.changes)


def conditions(_: RungeKutta) -> tuple[Condition, ...]:
    """None: no explicit method is symplectic for every H."""
    return ()
