"""Runge–Kutta methods by their coefficients, explicit or implicit.

k_i = f(z + h Σ a_ij k_j, t + c_i h), i = 1 … s, and z' = z + h Σ b_i k_i. In a partitioned method
the equations p' = −H_q and q' = H_p have two matrices and two vectors of weights, and the same
stages. Coefficients are exact algebraic numbers. Conditions on them are decided by exact algebra in
the ring of `verify.algebra.embedding.embed`; a residual that is not zero is enclosed by Arb.

The right clock is c = A 1. With t as one more coordinate, t' = 1, the system is autonomous, and t
has the value t + h Σ_j a_ij at stage i: so the method with this clock has the properties that it
has without time. In a partitioned method t may move with q or with p, so that both c = A_q 1 and
c = A_p 1 are right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import islice, product
from typing import Any, TypeAlias

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.lazy_sympy import sympy
from verify.schemes.conditions.condition import Condition, condition_of
from verify.schemes.conditions.tree_weights import Tableau, TreeWeights
from verify.schemes.steps.step_algebra import Number, Step, StepAlgebra

Clock: TypeAlias = "tuple[sympy.Expr | None, ...]"  # times in parts of h; None for a right one
SHOWN = 5  # digits in which a residual is printed


@dataclass(frozen=True)
class ImplicitTableau:
    """A Runge–Kutta tableau.

    `rows[i][j]`: a_ij. `weights`: b_i. `clock`: c_i, for an H that depends on time; None without
    time. `of_q`: in a partitioned method the tableau of q', without times; this one is then that of
    p'. Raises ValueError if their lengths do not match or coefficients are no constants.
    """

    rows: tuple[tuple[sympy.Expr, ...], ...]
    weights: tuple[sympy.Expr, ...]
    clock: Clock | None = None
    of_q: ImplicitTableau | None = None

    def __post_init__(self) -> None:
        count = len(self.weights)
        if count == 0 or [len(row) for row in self.rows] != [count] * count:
            raise ValueError("a tableau has as many rows, and entries in each, as weights")
        if {part.stages for part in self.parts} | {len(self.clock or self.weights)} != {count}:
            raise ValueError("the clock, and the part of q', have as many stages as there are")
        numbers = [x for row in (*self.rows, self.weights) for x in row]
        if any(sympy.sympify(x).free_symbols for x in numbers):
            raise ValueError("coefficients are numbers")

    @classmethod
    def from_numbers(
        cls, rows: Sequence[Sequence[sympy.Expr | int]], weights: Sequence[sympy.Expr | int]
    ) -> ImplicitTableau:
        """Return the tableau of these numbers, as exact expressions."""
        exact = [[sympy.sympify(x) for x in row] for row in (*rows, weights)]
        return cls(tuple(map(tuple, exact[:-1])), tuple(exact[-1]))

    def with_times(self, clock: Sequence[sympy.Expr | int | None] | None = None) -> ImplicitTableau:
        """Return the tableau with these times, in parts of h; None (the default) for right ones."""
        times = (None,) * self.stages if clock is None else clock
        return replace(self, clock=tuple(None if c is None else sympy.sympify(c) for c in times))

    @property
    def parts(self) -> tuple[ImplicitTableau, ...]:
        """The tableau itself; of a partitioned method the tableaux of p' and of q'."""
        return (self,) if self.of_q is None else (self, self.of_q)

    @property
    def stages(self) -> int:
        """The number of stages."""
        return len(self.weights)

    @cached_property
    def numbers(self) -> TableauNumbers:
        """The coefficients as elements of one ring."""
        return TableauNumbers.from_tableau(self)

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return conditions that suffice for det J ≡ 1, for every H and any clock.

        They are b_i a_ij + b_j a_ji − b_i b_j = 0 for i ≤ j; in a partitioned method
        b_p,i a_q,ij + b_q,j a_p,ji = b_p,i b_q,j for all i, j, and b_p = b_q (Sanz-Serna 1988;
        Hairer, Lubich, Wanner, Geometric Numerical Integration, theorems VI.4.3 and VI.4.6).
        """
        return _area_conditions(self)


@lru_cache(maxsize=64)
def _area_conditions(tableau: ImplicitTableau) -> tuple[Condition, ...]:
    numbers = tableau.numbers
    return tuple(numbers.condition(name, 0, gap) for name, gap in _area_gaps(numbers))


def _area_gaps(numbers: TableauNumbers) -> Iterator[tuple[str, Poly]]:
    of_p, of_q = numbers.blocks[0], numbers.blocks[-1]
    (a, u), (b, v) = (of_p.matrix, of_p.weights), (of_q.matrix, of_q.weights)
    two = len(numbers.blocks) == 2
    p, q = ("_p", "_q") if two else ("_", "_")
    for i, j in product(range(len(u)), repeat=2):
        m, n = i + 1, j + 1
        if two or i <= j:
            name = f"b{p}{m} a{q}{m}{n} + b{q}{n} a{p}{n}{m} = b{p}{m} b{q}{n}"
            yield name, u[i] * b[i][j] + v[j] * a[j][i] - u[i] * v[j]
    for m, (x, y) in enumerate(zip(u, v, strict=True), start=1) if two else ():
        yield f"b_p{m} = b_q{m}", x - y


@dataclass(frozen=True)
class TableauNumbers:
    """The numbers a_ij, b_i and c_i as elements of a ring without variables, a block a part."""

    ring: Ring
    blocks: tuple[Tableau[Poly], ...]

    @classmethod
    def from_tableau(cls, tableau: ImplicitTableau) -> TableauNumbers:
        """Return the numbers of a tableau, embedded together."""
        count, clock_times = tableau.stages, [c for c in tableau.clock or () if c is not None]
        rows = [row for part in tableau.parts for row in (part.weights, *part.rows)]
        ring, elements = embed([*(x for row in rows for x in row), *clock_times], ())
        # They are read in the order in which they were embedded: for each part b, then the rows of
        # a; the times last.
        remaining = iter(elements)

        def row() -> tuple[Poly, ...]:
            return tuple(islice(remaining, count))

        parts = [(row(), tuple(row() for _ in range(count))) for _ in tableau.parts]
        times = None
        if tableau.clock is not None:  # in a partitioned method time moves with q
            pairs = zip(_row_sums(ring, parts[-1][1]), tableau.clock, strict=True)
            times = tuple(x if c is None else next(remaining) for x, c in pairs)
        return cls(ring, tuple(Tableau(a, b, times) for b, a in parts))

    @property
    def a(self) -> tuple[tuple[Poly, ...], ...]:
        """The matrix a_ij; in a partitioned method that of p'."""
        return self.blocks[0].matrix

    @property
    def b(self) -> tuple[Poly, ...]:
        """The weights b_i; in a partitioned method those of p'."""
        return self.blocks[0].weights

    @property
    def clock(self) -> tuple[Poly, ...]:
        """The times c_i; empty without time."""
        return self.blocks[0].times or ()

    @cached_property
    def right(self) -> bool:
        """True if c is exactly a right clock, or there is no clock."""
        decide = self.ring.decide
        return any(
            all(
                decide(c - x).zero is True
                for c, x in zip(self.clock, _row_sums(self.ring, block.matrix), strict=False)
            )
            for block in self.blocks
        )

    @cached_property
    def tree_weights(self) -> TreeWeights[Poly]:
        """The weights b·Φ(t) of trees for these numbers."""
        return TreeWeights(self.blocks, self.ring.one, reduce=self.ring.reduce)

    def condition(self, name: str, order: int, gap: Poly) -> Condition:
        """Return the condition that `gap`, left side − right side, is 0."""
        return condition_of(self.ring, name, order, gap, SHOWN)


def _row_sums(ring: Ring, matrix: Sequence[Sequence[Poly]]) -> list[Poly]:
    return [ring.reduce(sum(row, ring.zero)) for row in matrix]


def implicit_step(
    rows: Sequence[Sequence[Number]], weights: Sequence[Number], clocks: Sequence[Number]
) -> Step:
    """Return the step z ↦ z' of a tableau a_ij, b_i, c_i of elements of the ring of H's field."""

    def changes(outer: StepAlgebra[Any]) -> list[Any]:
        size = outer.size

        def combine(
            algebra: StepAlgebra[Any],
            weight_rows: Sequence[Sequence[Number]],
            unknowns: Sequence[Any],
        ) -> list[Any]:
            """Return h Σ w_j f(z + Z_j) for each row w of weights, one after the other."""
            slopes = [
                algebra.slopes(unknowns[size * i : size * (i + 1)], clock, range(size))
                for i, clock in enumerate(clocks)
            ]
            pairs = product(weight_rows, zip(*slopes, strict=True))
            return [algebra.move(algebra.nothing, row, column) for row, column in pairs]

        # The unknowns are Z_i = Y_i − z = O(h): they are rounded less than the stages Y_i.
        stage_changes = outer.solve(size * len(clocks), lambda inner, z: combine(inner, rows, z))
        return combine(outer, [weights], stage_changes)

    return changes
