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

Products = set[tuple[int, ...]]  # the places of the factors of each product


def is_kept_by_coefficients(step_map: StepMap, structure: Structure, scheme: Scheme | None) -> bool:
    """Return True if a theorem shows that a step keeps the structure, which the flow does keep."""
    if isinstance(structure, Volume) and structure.density == 1 and step_map.preserves_area:
        return True
    every_h = scheme.every_h if scheme else None
    if isinstance(structure, Symmetric):
        return is_symmetric(every_h, step_map.hamiltonian.time_dependent)
    products = products_of(structure, step_map.hamiltonian.coordinates)
    if products is not None:
        linear = all(len(x) == 1 for x in products)
        if step_map.keeps_quadratic and (linear or step_map.conditions_hold):
            return True
        if keeps_products(every_h, products, len(step_map.field.names) // 2):
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


def products_of(structure: Structure, names: Sequence[str]) -> Products | None:
    """Return the places of the factors of each product; None if it is no sum of products of one
    factor or two."""
    symbols = list(map(symbol, names))
    varying = {*symbols, symbol("t")}
    if isinstance(structure, FirstIntegral):
        x = structure.integral
        if symbol("t") in x.free_symbols or not x.is_polynomial(*symbols):
            return None
        monomials = x.as_poly(*symbols).monoms()
        if max(map(sum, monomials)) > 2:
            return None
        places = (tuple(k for k, n in enumerate(powers) for _ in range(n)) for powers in monomials)
        return {place for place in places if place}
    if any(x.free_symbols & varying for x in structure.formulas):
        return None
    if isinstance(structure, SymplecticForm):
        return set(structure.entries)
    is_area = isinstance(structure, Volume) and len(names) == 2
    return {(0, 1)} if is_area else None


def keeps_products(every_h: object, products: Products, half: int) -> bool:
    """Return True if a method keeps each sum of such products that the flow of an H keeps.

    `half`: the place of the first q.
    """
    pairs = [x for x in products if len(x) == 2]
    if isinstance(every_h, TreeConditions):
        tableau = every_h.tableau
        conditions_hold = all(condition.holds for condition in tableau.area_conditions())
        if tableau.of_q is None:
            return not pairs or conditions_hold
        # Hairer, Lubich, Wanner, theorem IV.2.4: of a partitioned method products of a p and a q.
        return conditions_hold and all(places_apart(pair, half) for pair in pairs)
    if isinstance(every_h, TaylorSeries | RungeKutta):
        return not pairs
    if not isinstance(every_h, StageEquations):
        return False
    of_one_half = len({k < half for x in products for k in x}) == 1
    return all(
        (stage.kick == stage.drift or of_one_half)
        and all(sum(stage.at_p if k < half else stage.at_q for k in pair) == 1 for pair in pairs)
        for stage in every_h.stages
    )


def places_apart(pair: tuple[int, ...], half: int) -> bool:
    """Return True if one place is that of a p, and one that of a q."""
    return len({k < half for k in pair}) == 2


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


def commutes(scheme: Scheme | None, structure: Reversible, names: Sequence[str]) -> bool:
    """Return True if an affine ρ maps the steps of the scheme for f to those for ρ_*f.

    Runge–Kutta methods and lieη commute with every affine map; a partitioned method, or a
    splitting, with those that leave p and q apart. If ρ turns the flow round, ρ_*f = −f, whose step
    is Φ_(−h).
    """
    every_h = scheme.every_h if scheme else None
    kinds = TaylorSeries | RungeKutta | TreeConditions | Splitting | StageEquations
    if not isinstance(every_h, kinds):
        return False
    together = _treats_all_alike(every_h)
    symbols = list(map(symbol, names))
    half = len(symbols) // 2
    for k, x in enumerate(structure.reflection):
        polynomial = x.as_poly(*symbols)
        if polynomial is None or polynomial.total_degree() > 1:
            return False
        others = symbols[half:] if k < half else symbols[:half]
        if not together and x.free_symbols.intersection(others):
            return False
    return True


def _treats_all_alike(every_h: object) -> bool:
    """Return True if the method's coefficients are the same for all coordinates."""
    if isinstance(every_h, TreeConditions):
        return every_h.tableau.of_q is None
    if isinstance(every_h, StageEquations):
        return all(s.kick == s.drift and s.at_p == s.at_q for s in every_h.stages)
    return isinstance(every_h, TaylorSeries | RungeKutta)
