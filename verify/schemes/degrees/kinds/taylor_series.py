"""lieη: the exact flow's Taylor polynomial, z' = Σ hⁿ/n! Xⁿz, n = 0 … η."""

from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State
from verify.schemes.every_hamiltonian import TaylorSeries

KIND = TaylorSeries


def build(coefficients: TaylorSeries, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    eta = coefficients.eta

    def series(most: int) -> State:
        terms = [field.term(n) for n in range(min(eta, most) + 1)]
        return tuple(Series.of(field.ring, own, most) for own in zip(*terms, strict=True))

    h = field.ring.variable("h")
    powers = [tuple(h**n * x for x in field.term(n)) for n in range(eta + 1)]
    closed = tuple(sum(own, field.ring.zero) for own in zip(*powers, strict=True))
    return CanonicalMap(hamiltonian, field, series, closed=closed, flow_up_to=eta)
