"""lieη: the exact flow's Taylor polynomial, z' = Σ hⁿ/n! Xⁿz, n = 0 … η."""

from verify.algebra.conditions import Condition
from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import Flow, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State
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
        lambda most: series_over(field, coefficients, most),
        closed=tuple(sum(own, field.ring.zero) for own in zip(*powers, strict=True)),
        flow_up_to=eta,
    )


def conditions(_: TaylorSeries) -> tuple[Condition, ...]:
    """None: no Taylor polynomial is symplectic for every H."""
    return ()


def series_over(field: Flow, coefficients: TaylorSeries, most: int) -> State:
    """z' up to h^most."""
    terms = [field.term(n) for n in range(min(coefficients.eta, most) + 1)]
    return tuple(Series.of(field.ring, own, most) for own in zip(*terms, strict=True))
