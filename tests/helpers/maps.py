"""Maps of the plane from their formulas, for tests."""

import sympy

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.formula_map import map_from_expressions, step_map_from_formulas
from verify.schemes.maps.step_map import StepMap


def by_formulas(hamiltonian: Hamiltonian, p_next: str, q_next: str) -> StepMap:
    """The map of these formulas; `q_next` may use p_next."""
    return step_map_from_formulas(hamiltonian, {"p_next": p_next, "q_next": q_next})


def by_expressions(hamiltonian: Hamiltonian, p_next: sympy.Expr, q_next: sympy.Expr) -> StepMap:
    """The map of these expressions in p, q and h."""
    return map_from_expressions(hamiltonian, (p_next, q_next))
