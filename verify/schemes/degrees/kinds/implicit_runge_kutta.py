"""Implicit Runge–Kutta methods: their series by iteration, symplectic by their coefficients.

b_i a_ij + b_j a_ji = b_i b_j for all i, j suffices for every H in any number of degrees of freedom
(Sanz-Serna 1988; Hairer, Lubich, Wanner, Geometric Numerical Integration, theorem VI.4.3).
"""

from collections.abc import Sequence

from verify.algebra.conditions import Condition
from verify.algebra.ring import Poly
from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap, State, slopes_at, start_of
from verify.schemes.tree_conditions import TreeConditions

KIND = TreeConditions


def build(coefficients: TreeConditions, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H; stage i is taken at t + c_i h."""
    tableau = coefficients.tableau
    count = tableau.stages
    numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
    field, exact = canonical_field(hamiltonian, *numbers)
    ring, places = field.ring, range(len(field.names))
    rows = [exact[count * i : count * (i + 1)] for i in range(count + 1)]

    def series(most: int) -> State:
        slopes = [[Series.of(ring, [x], 0) for x in field.slopes]] * count

        def moved(weights: Sequence[Poly], longest: int) -> list[Series]:
            """h Σ w_j k_j, as far as h^longest."""
            changes = []
            for place in places:
                total = Series.of(ring, [], longest)
                for w, slope in zip(weights, slopes, strict=True):
                    own = Series.of(ring, [ring.zero, *slope[place].coefficients], longest)
                    total += own.times(w)
                changes.append(total)
            return changes

        for longest in range(1, most):
            clocks = [Series.of(ring, [ring.zero, sum(row, ring.zero)], longest) for row in rows]
            points = [moved(row, longest) for row in rows[:-1]]
            slopes = [
                slopes_at(field, point, clock, places)
                for point, clock in zip(points, clocks, strict=False)
            ]
        pairs = zip(start_of(field, most), moved(rows[-1], most), strict=True)
        return tuple(x + y for x, y in pairs)

    return CanonicalMap(
        hamiltonian, field, series, conditions=conditions(coefficients), implicit=True
    )


def conditions(coefficients: TreeConditions) -> tuple[Condition, ...]:
    """Those of the module's text."""
    return coefficients.tableau.area_conditions()
