"""Explicit Runge–Kutta methods: stage by stage, each at t + c h where H depends on time."""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.conditions import Condition
from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import Flow, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State, slopes_at, start_of
from verify.schemes.every_hamiltonian import RungeKutta

KIND = RungeKutta


def build(coefficients: RungeKutta, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H."""
    field, _ = canonical_field(hamiltonian)
    return CanonicalMap(hamiltonian, field, lambda most: series_over(field, coefficients, most))


def conditions(_: RungeKutta) -> tuple[Condition, ...]:
    """None: no explicit method is symplectic for every H."""
    return ()


def series_over(field: Flow, coefficients: RungeKutta, most: int) -> State:
    """z' up to h^most."""
    ring, places = field.ring, range(len(field.names))
    still, one = Series.of(ring, [], most), Series.of(ring, [ring.one], most)

    def moved(weights: Sequence[Fraction], slopes: Sequence[list[Series]]) -> list[Series]:
        """h Σ w_j k_j, and h Σ w_j for the clock."""
        changes = []
        for own in range(len(places) + 1):
            total = still
            for w, slope in zip(weights, slopes, strict=True):
                total += slope[own].times(w)
            changes.append(total.shifted(1))
        return changes

    def slope(point: list[Series]) -> list[Series]:
        *changes, clock = point
        return [*slopes_at(field, changes, clock, places), one]

    *changes, _ = coefficients.step(slope, moved)
    return tuple(x + y for x, y in zip(start_of(field, most), changes, strict=True))
