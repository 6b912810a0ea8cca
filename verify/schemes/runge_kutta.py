"""Explicit Runge–Kutta schemes: k_i = f(z + h Σ a_ij k_j), j < i, and z' = z + h Σ b_i k_i.

The same few lines are read in two ways: with ring elements they make the map, stage by stage, and
with power series in h its Taylor series.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

from verify.algebra.power_series import Series, at_point, partials
from verify.hamiltonians.hamiltonian import Hamiltonian, VectorField
from verify.schemes.stages import Point, Stages
from verify.schemes.step_map import StepMap, Substep

At = TypeVar("At")
Slope = TypeVar("Slope")


@dataclass(frozen=True)
class Tableau:
    """`rows[i]`: a_ij for j < i, which has as many entries as there are stages before; `weights`:
    b_i. ValueError where they do not fit together, or Σ b_i ≠ 1.
    """

    rows: tuple[tuple[Fraction, ...], ...]
    weights: tuple[Fraction, ...]

    def __post_init__(self) -> None:
        if [len(row) for row in self.rows] != list(range(len(self.weights))):
            raise ValueError("row i of an explicit tableau has i entries, one row for each weight")
        if sum(self.weights) != 1:
            raise ValueError("the weights do not add up to 1")


def step(
    tableau: Tableau,
    slope: Callable[[At], Slope],
    moved: Callable[[Sequence[Fraction], Sequence[Slope]], At],
) -> At:
    """One step: `slope` is f, and `moved(weights, slopes)` is z + h Σ weights · slopes."""
    slopes: list[Slope] = []
    for row in tableau.rows:
        slopes.append(slope(moved(row, slopes)))
    return moved(tableau.weights, slopes)


def runge_kutta_map(hamiltonian: Hamiltonian, tableau: Tableau) -> StepMap:
    """The step map, for any H, in stages."""
    field, _ = hamiltonian.field()
    stages = Stages(field, len(tableau.weights))
    ring = stages.ring

    def moved(weights: Sequence[Fraction], slopes: Sequence[Point]) -> Point:
        p, q = stages.start
        for w, (u, v) in zip(weights, slopes, strict=True):
            part = ring.constant(w) * ring.variable("h")
            p, q = p + part * u, q + part * v
        return p, q

    substep = Substep(stages.field, *step(tableau, stages.slope, moved))
    return StepMap(hamiltonian, (substep,), lambda most: (field, *taylor(field, tableau, most)))


def taylor(field: VectorField, tableau: Tableau, most: int) -> tuple[Series, Series]:
    """The Taylor series of p' and q' up to h^most."""
    ring = field.ring
    start = [Series.of(ring, [ring.variable(name)], most) for name in ("p", "q")]
    gradient = [partials(ring, x) for x in (-field.h_q, field.h_p)]

    def moved(weights: Sequence[Fraction], slopes: Sequence[list[Series]]) -> list[Series]:
        result = []
        for i, x in enumerate(start):
            total = Series.of(ring, [], most)
            for w, k in zip(weights, slopes, strict=True):
                total += k[i].times(w)
            result.append(x + total.shifted(1))
        return result

    def slope(point: Sequence[Series]) -> list[Series]:
        u, v = (x - x0 for x, x0 in zip(point, start, strict=True))
        return [at_point(partial, u, v) for partial in gradient]

    p, q = step(tableau, slope, moved)
    return p, q
