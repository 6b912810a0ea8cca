"""Runge–Kutta methods for z' = f(z, t), the times of their stages as coefficients of their own.

Stage i is taken at t + c_i h. One part is a Runge–Kutta method as it is known; two are a
partitioned one, the first for p' = −H_q and the second for q' = H_p: of the same stages, but with
matrices and weights of their own.

The right clock is c = A 1. With t as one more coordinate, t' = 1, the system is autonomous, and t
has at stage i the value t + h Σ a_ij: so the method is what it is without time, for every H. Of a
partitioned method t may go with q or with p, and both c = A_q 1 and c = A_p 1 are right.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.schemes.conditions.every_hamiltonian import RungeKutta, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_weights import RingWeights, Tableau

Clock = tuple[sympy.Expr | None, ...]  # of the stages, as parts of h; None where it is right
Given = Sequence[sympy.Expr | int | None] | None  # None where all are right
Matrix = tuple[tuple[Poly, ...], ...]


@dataclass(frozen=True)
class TimedTableau:
    """`parts`: one, or those of p' and q'; `clock`: c_i. ValueError where they do not fit."""

    parts: tuple[ImplicitTableau, ...]
    clock: Clock

    def __post_init__(self) -> None:
        stages = {part.stages for part in self.parts}
        if len(self.parts) not in (1, 2) or stages != {len(self.clock)}:
            raise ValueError("one or two parts, each with as many stages as the clock has times")

    @classmethod
    def of(cls, tableau: ImplicitTableau, clock: Given = None) -> "TimedTableau":
        """One part; without `clock` with the right one."""
        return cls((tableau,), _clock(tableau.stages, clock))

    @classmethod
    def of_explicit(cls, method: RungeKutta, clock: Given = None) -> "TimedTableau":
        """An explicit method's."""
        rows, weights = method.square
        return cls.of(ImplicitTableau.of(_exact(rows), _exact([weights])[0]), clock)

    @classmethod
    def of_stages(cls, equations: StageEquations, clock: Given = None) -> "TimedTableau":
        """Stages that are made one after the other; one part where p and q are alike in them."""
        stages = equations.stages
        of_p = _one_after_the_other([(s.kick, s.at_p) for s in stages])
        of_q = _one_after_the_other([(s.drift, s.at_q) for s in stages])
        parts = (of_p,) if of_p == of_q else (of_p, of_q)
        return cls(parts, _clock(len(stages), clock))

    @property
    def stages(self) -> int:
        """How many stages there are."""
        return len(self.clock)

    @cached_property
    def numbers(self) -> "TimedNumbers":
        """The coefficients in one ring."""
        return TimedNumbers.of(self)


@dataclass(frozen=True)
class TimedNumbers:
    """Of each part its matrix and its weights, and c_i, as elements of a ring without variables.

    `right`: whether c is a right clock, exactly.
    """

    ring: Ring
    matrices: tuple[Matrix, ...]
    weights: tuple[tuple[Poly, ...], ...]
    clock: tuple[Poly, ...]
    right: bool

    @cached_property
    def tree_weights(self) -> RingWeights:
        """What they put into the conditions of trees."""
        pairs = zip(self.matrices, self.weights, strict=True)
        return RingWeights(self.ring, [Tableau(a, b, self.clock) for a, b in pairs])

    @classmethod
    def of(cls, tableau: TimedTableau) -> "TimedNumbers":
        """Those of a tableau, embedded together."""
        count = tableau.stages
        told = [c for c in tableau.clock if c is not None]
        rows = [row for part in tableau.parts for row in (*part.rows, part.weights)]
        ring, found = embed([*(x for row in rows for x in row), *told], ())
        numbers, rest = iter(found), iter(found[count * len(rows) :])
        matrices, weights = [], []
        for _ in tableau.parts:
            matrices.append(tuple(tuple(next(numbers) for _ in range(count)) for _ in range(count)))
            weights.append(tuple(next(numbers) for _ in range(count)))
        sums = [[ring.reduce(sum(row, ring.zero)) for row in matrix] for matrix in matrices]
        # Time is a coordinate: where there are two parts, it goes with q.
        clock = tuple(
            x if c is None else next(rest) for x, c in zip(sums[-1], tableau.clock, strict=True)
        )
        right = any(
            all(ring.decide(c - x).zero is True for c, x in zip(clock, own, strict=True))
            for own in sums
        )
        return cls(ring, tuple(matrices), tuple(weights), clock, right)


def _clock(stages: int, clock: Given) -> Clock:
    given = [None] * stages if clock is None else clock
    return tuple(None if c is None else sympy.sympify(c) for c in given)


def _exact(rows: Sequence[Sequence[object]]) -> list[list[sympy.Expr]]:
    return [[sympy.Rational(str(x)) for x in row] for row in rows]


def _one_after_the_other(stages: Sequence[tuple[object, object]]) -> ImplicitTableau:
    """z_i = z_(i−1) + h b_i f(z_(i−1) + at_i (z_i − z_(i−1)))."""
    ((*weights,), (*inner,)) = _exact(list(zip(*stages, strict=True)))
    rows = [
        [*weights[:i], at * weights[i], *[sympy.S.Zero] * (len(weights) - i - 1)]
        for i, at in enumerate(inner)
    ]
    return ImplicitTableau.of(rows, weights)
