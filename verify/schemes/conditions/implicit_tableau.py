"""Implicit Runge–Kutta methods by their coefficients.

k_i = f(z + h Σ a_ij k_j), i = 1 … s, and z' = z + h Σ b_i k_i. Coefficients are algebraic numbers,
exact. What is asked of them is decided in the ring of `verify.algebra.embedding.embed`, by exact
algebra, and what is not zero there is enclosed by Arb; no coefficient is ever rounded for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.late import sympy
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.residue import condition_of
from verify.schemes.conditions.tree_weights import RingWeights, Tableau
from verify.schemes.steps.step_algebra import Number, Step, StepAlgebra

SHOWN = 5  # digits of a residue


@dataclass(frozen=True)
class ImplicitTableau:
    """`rows[i][j]`: a_ij; `weights`: b_i. ValueError where they do not fit together, or are no
    constants."""

    rows: tuple[tuple[sympy.Expr, ...], ...]
    weights: tuple[sympy.Expr, ...]

    def __post_init__(self) -> None:
        count = len(self.weights)
        if count == 0 or [len(row) for row in self.rows] != [count] * count:
            raise ValueError("a tableau has as many rows, and entries in each, as weights")
        numbers = [x for row in (*self.rows, self.weights) for x in row]
        if any(sympy.sympify(x).free_symbols for x in numbers):
            raise ValueError("coefficients are numbers")

    @classmethod
    def of(
        cls, rows: Sequence[Sequence[sympy.Expr | int]], weights: Sequence[sympy.Expr | int]
    ) -> ImplicitTableau:
        """From numbers as sympy takes them."""
        exact = [[sympy.sympify(x) for x in row] for row in (*rows, weights)]
        return cls(tuple(map(tuple, exact[:-1])), tuple(exact[-1]))

    @property
    def stages(self) -> int:
        """How many stages there are."""
        return len(self.weights)

    @cached_property
    def numbers(self) -> Numbers:
        """The coefficients in one ring."""
        return Numbers.of(self)

    def area_conditions(self) -> tuple[Condition, ...]:
        """b_i a_ij + b_j a_ji − b_i b_j = 0 for i ≤ j.

        They suffice for det J ≡ 1, for every H (Sanz-Serna 1988; Hairer, Lubich, Wanner, Geometric
        Numerical Integration, theorem VI.4.3).
        """
        return _area_conditions(self)


@lru_cache(maxsize=64)
def _area_conditions(tableau: ImplicitTableau) -> tuple[Condition, ...]:
    numbers = tableau.numbers
    a, b = numbers.a, numbers.b
    return tuple(
        numbers.condition(
            f"b_{i + 1} a_{i + 1}{j + 1} + b_{j + 1} a_{j + 1}{i + 1} = b_{i + 1} b_{j + 1}",
            0,
            b[i] * a[i][j] + b[j] * a[j][i] - b[i] * b[j],
        )
        for i in range(tableau.stages)
        for j in range(i, tableau.stages)
    )


@dataclass(frozen=True)
class Numbers:
    """a_ij and b_i as elements of a ring without variables."""

    ring: Ring
    a: tuple[tuple[Poly, ...], ...]
    b: tuple[Poly, ...]

    @classmethod
    def of(cls, tableau: ImplicitTableau) -> Numbers:
        """Those of a tableau, embedded together."""
        count = tableau.stages
        ring, found = embed([*tableau.weights, *(x for row in tableau.rows for x in row)], ())
        rows = [tuple(found[count * (i + 1) : count * (i + 2)]) for i in range(count)]
        return cls(ring, tuple(rows), tuple(found[:count]))

    @cached_property
    def tree_weights(self) -> RingWeights:
        """What they put into the conditions of trees."""
        return RingWeights(self.ring, [Tableau(self.a, self.b)])

    def condition(self, name: str, order: int, gap: Poly) -> Condition:
        """The condition that `gap`, left side − right side, is 0."""
        return condition_of(self.ring, name, order, gap, SHOWN)


def implicit_step(
    rows: Sequence[Sequence[Number]], weights: Sequence[Number], clocks: Sequence[Number]
) -> Step:
    """How z' is made: a_ij, b_i and c_i in the ring of H's field."""

    def changes(outer: StepAlgebra[Any]) -> list[Any]:
        size = outer.size

        def combined(
            algebra: StepAlgebra[Any], own: Sequence[Sequence[Number]], unknowns: Sequence[Any]
        ) -> list[Any]:
            """h Σ w_j f(z + Z_j) of each row of weights, row after row."""
            stages = [unknowns[size * i : size * (i + 1)] for i in range(len(clocks))]
            slopes = [
                algebra.slopes(stage, clock, range(size))
                for stage, clock in zip(stages, clocks, strict=True)
            ]
            columns = [[slope[k] for slope in slopes] for k in range(size)]
            return [
                algebra.moved(algebra.nothing, row, column) for row in own for column in columns
            ]

        solved = outer.solved(size * len(clocks), lambda inner, z: combined(inner, rows, z))
        return combined(outer, [weights], solved)

    return changes
