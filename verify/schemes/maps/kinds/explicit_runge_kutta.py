"""Explicit Runge–Kutta methods; if H depends on time, stage i is at t + c_i h."""

from fractions import Fraction
from functools import partial

from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.maps.step_map import StepMap


def build(
    coefficients: RungeKutta,
    hamiltonian: Hamiltonian,
    name: str = "",
    standing: Fraction | None = None,
) -> StepMap:
    """Return the map for any H.

    `standing`: every stage is at t + `standing` h, which is a wrong clock (see
    `verify.schemes.methods.user.wrong_clocks`); None for the right clock.
    """
    field, _ = field_of(hamiltonian)
    return StepMap(hamiltonian, field, partial(coefficients.changes, standing=standing))


def conditions(_: RungeKutta, degrees: int) -> tuple[Condition, ...]:
    """Return no conditions: no explicit method is symplectic for every H."""
    return ()
