"""Implicit Runge–Kutta methods: symplectic by their coefficients.

The unknowns are Z_i = Y_i − z, Y_i the points at which the slopes are taken:
Z_i = h Σ a_ij f(z + Z_j), and z' = z + h Σ b_i f(z + Z_i). That b_i a_ij + b_j a_ji = b_i b_j for
all i, j suffices for S ≡ 0, for every H in any number of degrees of freedom (Sanz-Serna 1988;
Hairer, Lubich, Wanner, Geometric Numerical Integration, theorem VI.4.3).
"""

from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.implicit_tableau import implicit_step
from verify.schemes.tree_conditions import TreeConditions

KIND = TreeConditions


def build(coefficients: TreeConditions, hamiltonian: Hamiltonian) -> CanonicalMap:
    """The map for any H; stage i is taken at t + c_i h."""
    tableau = coefficients.tableau
    count = tableau.stages
    numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
    field, exact = canonical_field(hamiltonian, *numbers)
    rows = [exact[count * i : count * (i + 1)] for i in range(count)]
    clocks = [sum(row, field.ring.zero) for row in rows]
    return CanonicalMap(
        hamiltonian,
        field,
        implicit_step(rows, exact[count * count :], clocks),
        conditions=conditions(coefficients),
        implicit=True,
    )


def conditions(coefficients: TreeConditions) -> tuple[Condition, ...]:
    """Those of the module's text."""
    return coefficients.tableau.area_conditions()
