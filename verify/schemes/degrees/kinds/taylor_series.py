"""lieη: the exact flow's Taylor polynomial, z' = Σ hⁿ/n! Xⁿz, n = 0 … η."""

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.every_hamiltonian import TaylorSeries

KIND = TaylorSeries


def build(coefficients: TaylorSeries, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    eta, h = coefficients.eta, field.ring.variable("h")
    powers = [tuple(h**n * x for x in field.term(n)) for n in range(eta + 1)]
    return CanonicalMap(
        hamiltonian,
        field,
        coefficients.changes,
        closed=tuple(sum(own, field.ring.zero) for own in zip(*powers, strict=True)),
        flow_up_to=eta,
    )


def conditions(_: TaylorSeries) -> tuple[Condition, ...]:
    """None: no Taylor polynomial is symplectic for every H."""
    return ()
