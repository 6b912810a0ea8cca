"""An integration scheme: its name, its claims as data, and how its step map is built."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from verify.drawable import drawn_by
from verify.errors import InputError
from verify.hamiltonians.equations import Equations
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.condition import ByConditions
from verify.schemes.conditions.every_hamiltonian import (
    BySeries,
    RungeKutta,
    StageEquations,
    TaylorSeries,
)
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.maps import kind_of
from verify.schemes.maps.formula_map import step_map_from_formulas
from verify.schemes.maps.step_map import StepMap


@drawn_by("schemes")
@dataclass(frozen=True)
class Scheme:
    """A one-step scheme; tests compare its claims with proofs.

    - `order`: the claimed order of convergence.
    - `area_preserving`: the claim that det J ≡ 1 for every H that the scheme takes.
    - `explicit`: True if no equation is solved.
    - `symmetric`: the claim that a step of −h undoes a step of h.
    - `source`: the publication that defines it.
    - `every_h`: its coefficients, for every H; None if it is known for one H at a time.
    - `formulas`: the formulas of a user's own map, by name: p_next and q_next, or p1_next, ….
    - `build`: builds the map for an H if neither `every_h` nor `formulas` does; raises InputError
      for an H that the scheme does not take.
    - `takes_equations`: True if `build` takes equations without an H.
    """

    name: str
    order: int
    area_preserving: bool = False
    explicit: bool = True
    symmetric: bool = False
    source: str = ""
    build: Callable[[Hamiltonian], StepMap] | None = None
    every_h: BySeries | ByConditions | None = None
    formulas: Mapping[str, str] = field(default_factory=dict, hash=False)
    takes_equations: bool = False

    def __repr__(self) -> str:
        area = "det J ≡ 1" if self.area_preserving else "area not preserved"
        return f"Scheme({self.name}: order {self.order}, {area})"

    @property
    def needs_separable(self) -> bool:
        """True if the scheme is defined for H = T(p) + V(q) only."""
        return bool(getattr(self.every_h, "separable", False))

    @property
    def evaluations(self) -> dict[str, int] | None:
        """The numbers of evaluations of H_p and of H_q in a step; None if not countable."""
        return getattr(self.every_h, "evaluations", None)

    def step_map(self, hamiltonian: Hamiltonian) -> StepMap:
        """Return the exact map of one step for H; h and parameters without a value are symbols.

        Raises InputError for an H that the scheme does not take, such as one that is not separable.
        """
        return _step_map(self, hamiltonian)


# A scene needs the same map when it is read, proved and run, and derived results are cached with
# the map. The cache is small, since a map keeps all that was derived from it.
@lru_cache(maxsize=32)
def _step_map(scheme: Scheme, hamiltonian: Hamiltonian) -> StepMap:
    if isinstance(hamiltonian, Equations):
        _check_takes_equations(scheme, hamiltonian)
    if scheme.build is not None:
        return scheme.build(hamiltonian)
    if scheme.formulas:
        return step_map_from_formulas(hamiltonian, scheme.formulas)
    step_map: StepMap = kind_of(scheme.every_h, scheme.name).build(
        scheme.every_h, hamiltonian, scheme.name
    )
    return step_map


def _check_takes_equations(scheme: Scheme, equations: Equations) -> None:
    """Raise InputError unless the scheme is one of a field, without p and q of its own."""
    every_h = scheme.every_h
    is_partitioned = getattr(getattr(every_h, "tableau", None), "of_q", None) is not None
    of_fields = isinstance(every_h, TaylorSeries | RungeKutta | TreeConditions)
    if isinstance(every_h, StageEquations):  # all coordinates alike, as those of the midpoint
        stages = every_h.stages
        of_fields = all(s.kick == s.drift and s.at_p == s.at_q for s in stages)
    of_fields = (of_fields and not is_partitioned) or bool(scheme.formulas)
    if not of_fields and not scheme.takes_equations:
        allowed = "lieη, Runge–Kutta methods, formulas such as u_next = …, splittings of the field"
        problem = f"takes an H, and {equations.formula} has none; allowed: {allowed}"
        raise InputError("scheme", scheme.name, problem)
