"""lieη: the exact flow's Taylor polynomial, z' = Σ hⁿ/n! Xⁿz, n = 0 … η."""

from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.step_map import StepMap


def build(coefficients: TaylorSeries, hamiltonian: Hamiltonian, name: str = "") -> StepMap:
    """Return the map for any H."""
    field, _ = field_of(hamiltonian)
    # The Taylor polynomial is the closed form: no series has to be expanded.
    changes = field.flow_changes(coefficients.eta)
    formulas = tuple(x + y for x, y in zip(field.start, changes, strict=True))
    return StepMap(hamiltonian, field, formulas=formulas)


def conditions(_: TaylorSeries, degrees: int) -> tuple[Condition, ...]:
    """Return no conditions: no Taylor polynomial is symplectic for every H."""
    return ()
