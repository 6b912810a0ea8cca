"""Kicks and drifts in turn, for H = T(p) + V(q): each is a shear, and symplectic.

A kick moves p by −a h ∂V/∂q. The one block of its Jacobian that is neither 0 nor 1 is −a h Hess V,
and S of a shear is that block less its transpose, which is 0.
"""

from collections.abc import Sequence

from verify.algebra.conditions import Condition
from verify.algebra.series.power_series import Series
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State, slopes_at, start_of
from verify.schemes.splitting import all_times
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
    ring, n = field.ring, field.degrees
    of_kind = {"kick": range(n), "drift": range(n, 2 * n)}

    def series(most: int) -> State:
        start = start_of(field, most)
        changes: Sequence[Series] = [Series.of(ring, [], most)] * (2 * n)
        each = zip(parts, exact[: len(parts)], exact[len(parts) :], strict=True)
        for (kind, _), size, time in each:
            places = of_kind[kind]
            clock = Series.of(ring, [ring.zero, time], most)
            moved = slopes_at(field, changes, clock, places)
            changes = list(changes)
            for place, slope in zip(places, moved, strict=True):
                changes[place] += slope.times(size).shifted(1)
        return tuple(x + y for x, y in zip(start, changes, strict=True))

    kinds = dict.fromkeys(kind for kind, _ in parts)
    shears = tuple(_condition(field, kind, of_kind[kind]) for kind in kinds)
    return CanonicalMap(hamiltonian, field, series, conditions=shears)


def _condition(field: CanonicalField, kind: str, places: range) -> Condition:
    """That what it moves by is a gradient: its Jacobian's block is symmetric."""
    n, ring = field.degrees, field.ring
    by = [field.names[(place + n) % (2 * n)] for place in places]
    rows = [[ring.diff(field.slopes[place], name) for name in by] for place in places]
    gaps = [rows[i][j] - rows[j][i] for i in range(n) for j in range(i)]
    holds = all(ring.vanishes(gap) is True for gap in gaps)
    return Condition(f"every {kind} is a shear by a gradient", 0, "0" if holds else "?", holds)
