"""Theorems by which a scheme keeps a structure of the flow: from its coefficients, for all h.

- A structure that is a sum of products z_a z_b or dz_a∧dz_b, with linear terms: its change is
  h times its derivative along f, at the stages, if M = 0 (Hairer, Lubich, Wanner, theorems IV.1.5
  and IV.2.2; forms by the variational equations, VI.4), or if stages that are solved one after the
  other are at shares of z_a' − z_a and z_b' − z_b that add up to 1. A linear one is kept by Runge–
  Kutta methods and by lieη, whose terms are those of I's derivatives along f.
- A splitting keeps what the flow of each of its parts keeps.
- ρΦ_hρ is Φ_(−h) for a scheme that commutes with ρ; so a step is reversible if it is symmetric.
"""

from collections.abc import Sequence

from verify.algebra.formula import symbol
from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.structures.structure_values import series_values
from verify.schemes.conditions.every_hamiltonian import RungeKutta, StageEquations, TaylorSeries
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.symmetric_coefficients import is_symmetric
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.schemes.steps.step_algebra import StepAlgebra
from verify.structures import Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible
from verify.structures.structure import Value
from verify.structures.symmetric import Symmetric
from verify.structures.symplectic import SymplecticForm
from verify.structures.volume import Volume

_OF_FIELDS = TaylorSeries | RungeKutta | TreeConditions  # all coordinates are treated alike
_Pairs = set[tuple[int, int]]


def is_kept_by_coefficients(step_map: StepMap, structure: Structure, scheme: Scheme | None) -> bool:
    """Return True if a theorem shows that a step keeps the structure, which the flow does keep."""
    if isinstance(structure, Volume) and structure.density == 1 and step_map.preserves_area:
        return True
    every_h = scheme.every_h if scheme else None
    if isinstance(structure, Symmetric):
        return is_symmetric(every_h, step_map.hamiltonian.time_dependent)
    pairs = _pairs_of(structure, step_map.hamiltonian.coordinates)
    if pairs is not None and _keeps_products(step_map, every_h, pairs):
        return True
    return isinstance(every_h, Splitting) and _is_kept_by_parts(step_map.hamiltonian, structure)


def flow_defect(
    hamiltonian: Hamiltonian, structure: Structure, places: Sequence[int] | None = None
) -> dict[str, Value]:
    """Return the defect of z + h f(z) as series up to h¹.

    The flow is a group: it keeps the structure if the coefficient of h is 0 everywhere. `places`:
    the components of f, and the others are 0; by default all.
    """
    field, _ = field_of(hamiltonian)

    def step(algebra: StepAlgebra[Value]) -> list[Value]:
        if places is None:
            return algebra.along_flow(1)
        still, ring = [algebra.nothing] * algebra.size, field.ring
        return algebra.shear(still, ring.one, ring.zero, places)

    return structure.defect(series_values(StepMap(hamiltonian, field, step), structure, 1))


# -- sums of products ------------------------------------------------------------------------------


def _pairs_of(structure: Structure, names: Sequence[str]) -> _Pairs | None:
    """Return the places a, b of the products in the structure; None if it is no sum of products."""
    symbols = list(map(symbol, names))
    varying = {*symbols, symbol("t")}
    if isinstance(structure, FirstIntegral):
        x = structure.integral
        if symbol("t") in x.free_symbols or not x.is_polynomial(*symbols):
            return None
        monomials = x.as_poly(*symbols).monoms()
        if max(map(sum, monomials)) > 2:
            return None
        places = ([k for k, n in enumerate(powers) for _ in range(n)] for powers in monomials)
        return {(place[0], place[1]) for place in places if len(place) == 2}
    if any(x.free_symbols & varying for x in structure.formulas):
        return None
    if isinstance(structure, SymplecticForm):
        return set(structure.entries)
    is_area = isinstance(structure, Volume) and len(names) == 2
    return {(0, 1)} if is_area else None


def _keeps_products(step_map: StepMap, every_h: object, pairs: _Pairs) -> bool:
    if step_map.keeps_quadratic:
        return not pairs or step_map.conditions_hold
    if isinstance(every_h, _OF_FIELDS):
        return not pairs
    if not isinstance(every_h, StageEquations):
        return False
    half = len(step_map.field.names) // 2
    return all(
        stage.kick == stage.drift
        and all(sum(stage.at_p if k < half else stage.at_q for k in pair) == 1 for pair in pairs)
        for stage in every_h.stages
    )


def _is_kept_by_parts(hamiltonian: Hamiltonian, structure: Structure) -> bool:
    """Return True if kicks and drifts keep the structure, each alone."""
    if any(symbol("t") in x.free_symbols for x in structure.formulas):
        return False
    half = len(hamiltonian.coordinates) // 2
    return all(
        series.ring.vanishes(series.coefficients[1]) is True
        for places in (range(half), range(half, 2 * half))
        for series in flow_defect(hamiltonian, structure, places).values()
    )


# -- reversibility ---------------------------------------------------------------------------------


def commutes(scheme: Scheme | None, structure: Reversible, hamiltonian: Hamiltonian) -> bool:
    """Return True if an affine ρ maps the steps of the scheme for f to those for ρ_*f.

    Runge–Kutta methods and lieη commute with every affine map; a partitioned method, or a
    splitting, with those that leave p and q apart. If ρ turns the flow round, ρ_*f = −f, whose step
    is Φ_(−h).
    """
    every_h = scheme.every_h if scheme else None
    if not isinstance(every_h, _OF_FIELDS | Splitting | StageEquations):
        return False
    together = isinstance(every_h, _OF_FIELDS) or (
        isinstance(every_h, StageEquations)
        and all(s.kick == s.drift and s.at_p == s.at_q for s in every_h.stages)
    )
    symbols = list(map(symbol, hamiltonian.coordinates))
    half = len(symbols) // 2
    for k, x in enumerate(structure.reflection):
        polynomial = x.as_poly(*symbols)
        if polynomial is None or polynomial.total_degree() > 1:
            return False
        others = symbols[half:] if k < half else symbols[:half]
        if not together and x.free_symbols.intersection(others):
            return False
    return True
