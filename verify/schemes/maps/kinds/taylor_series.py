"""lieη: the exact flow's Taylor polynomial, z' = Σ hⁿ/n! Xⁿz, n = 0 … η."""

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.step_map import StepMap

KIND = TaylorSeries


def build(coefficients: TaylorSeries, hamiltonian: Hamiltonian, name: str = "") -> StepMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    eta, h = coefficients.eta, field.ring.variable("h")
    powers = [tuple(h**n * x for x in field.term(n)) for n in range(eta + 1)]
    formulas = tuple(sum(own, field.ring.zero) for own in zip(*powers, strict=True))
    return StepMap(hamiltonian, field, formulas=formulas)


def conditions(_: TaylorSeries, degrees: int) -> tuple[Condition, ...]:
    """None: no Taylor polynomial is symplectic for every H."""
    return ()
