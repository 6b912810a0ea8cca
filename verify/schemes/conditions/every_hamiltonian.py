"""Schemes for every H: step maps of an H that is not specified.

The jets are the partial derivatives of H at z, as free variables. `taylor(jets, most)` returns the
coefficients of h⁰ … h^most of z' as polynomials in the jets, in their degrees of freedom.
`StageEquations` also have their equations, which give det J without being solved.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, ClassVar, Protocol, TypeVar, runtime_checkable

import flint

from verify.algebra.jets import JetsInDegrees, Poly, Series
from verify.hamiltonians.canonical_field import JetField
from verify.lazy_sympy import sympy
from verify.prose import count
from verify.schemes.conditions.condition import Condition
from verify.schemes.steps.step_algebra import StepAlgebra, series_of

At = TypeVar("At")
Slope = TypeVar("Slope")


@runtime_checkable
class BySeries(Protocol):
    """A scheme with a Taylor series, for every H, or if `separable` for every H = T(p) + V(q).

    The name must not be Generic: `typing` ignores the members of a protocol of that name, so that
    every object would be an instance.
    """

    @property
    def separable(self) -> bool: ...

    def taylor(self, jets: JetsInDegrees, most: int) -> tuple[Series, ...]: ...


class ByChanges(ABC):
    """A scheme whose step, and so its series, is written in the operations of a step algebra."""

    @abstractmethod
    def changes(self, algebra: StepAlgebra[Any]) -> list[Any]:
        """Return z' − z."""

    def taylor(self, jets: JetsInDegrees, most: int) -> tuple[Series, ...]:
        """Return z' as series up to h^most; see `BySeries`."""
        state = series_of(JetField.from_jets(jets), self.changes, most)
        return tuple(list(x.coefficients) for x in state)


@dataclass(frozen=True)
class TaylorSeries(ByChanges):
    """The Taylor series of the exact flow, truncated after h^eta: `lieη` of the paper (Eq. 2)."""

    eta: int
    separable: bool = False
    kind: ClassVar[str] = "taylor-series"  # the file of `verify.schemes.maps.kinds`

    @property
    def a_step(self) -> str:
        """The cost of a step, in words."""
        return f"derivatives of p and q along the flow, up to X^{self.eta}"

    def changes(self, algebra: StepAlgebra[Any]) -> list[Any]:
        """Return z' − z, the terms of the exact flow up to h^eta."""
        return algebra.along_flow(self.eta)


@dataclass(frozen=True)
class RungeKutta(ByChanges):
    """An explicit Runge–Kutta method: k_i = f(z + h Σ a_ij k_j), j < i, and z' = z + h Σ b_i k_i.

    `rows[i]`: a_ij for j < i, so that row i has i entries, from i = 0 on; `weights`: b_i. Raises
    ValueError if their lengths do not match, or Σ b_i ≠ 1.
    """

    rows: tuple[tuple[Fraction, ...], ...]
    weights: tuple[Fraction, ...]
    separable: bool = False
    kind: ClassVar[str] = "explicit-runge-kutta"

    def __post_init__(self) -> None:
        if [len(row) for row in self.rows] != list(range(len(self.weights))):
            raise ValueError("row i of an explicit tableau has i entries, one row for each weight")
        if sum(self.weights) != 1:
            raise ValueError("the weights do not add up to 1")

    @property
    def evaluations(self) -> dict[str, int]:
        """The evaluations of H_p and of H_q in a step."""
        return dict.fromkeys(("H_p", "H_q"), len(self.weights))

    @property
    def a_step(self) -> str:
        """The cost of a step, in words."""
        return count(len(self.weights), "stage")

    def step(
        self,
        slope: Callable[[At], Slope],
        move: Callable[[Sequence[Fraction], Sequence[Slope]], At],
    ) -> At:
        """Make one step: `slope` is f, and `move(weights, slopes)` is z + h Σ weights · slopes."""
        slopes: list[Slope] = []
        for row in self.rows:
            slopes.append(slope(move(row, slopes)))
        return move(self.weights, slopes)

    def changes(self, algebra: StepAlgebra[Any], standing: Fraction | None = None) -> list[Any]:
        """Return z' − z, stage by stage.

        If H depends on time, stage i is at t + c_i h; or with `standing` every stage at
        t + `standing` h.
        """
        places = range(algebra.size)

        def move(
            weights: Sequence[Fraction], slopes: Sequence[list[Any]]
        ) -> tuple[list[Any], Fraction]:
            """Return the change h Σ weights · slopes of z, and the change of t in parts of h."""
            columns = [[slope[k] for slope in slopes] for k in places]
            changes_of_z = [algebra.move(algebra.nothing, weights, column) for column in columns]
            # The weights' sum is c_i, so that t moves like a coordinate with slope 1.
            return changes_of_z, sum(weights, Fraction(0))

        def slope(stage: tuple[list[Any], Fraction]) -> list[Any]:
            change, clock = stage
            return algebra.slopes(change, clock if standing is None else standing, places)

        return self.step(slope, move)[0]


@dataclass(frozen=True)
class Stage:
    """One stage: p' = p − h·kick·H_q(P, Q) and q' = q + h·drift·H_p(P, Q).

    Its point is P = p + at_p·(p' − p), Q = q + at_q·(q' − q).
    """

    kick: Fraction
    drift: Fraction
    at_p: Fraction = Fraction(0)
    at_q: Fraction = Fraction(0)


@dataclass(frozen=True)
class StageEquations(ByChanges):
    """Stages that are solved and applied one after the other."""

    stages: tuple[Stage, ...]
    separable: bool = False
    kind: ClassVar[str] = "stage-equations"

    @property
    def a_step(self) -> str:
        """The cost of a step, in words."""
        return f"{count(len(self.stages), 'stage')}, solved by Newton's method"

    @classmethod
    def from_shears(cls, parts: Sequence[tuple[str, sympy.Rational]]) -> StageEquations:
        """Return the stages of kicks and drifts, each with its part of h, for H = T(p) + V(q)."""
        stages = []
        for kind, size in parts:
            length, none = Fraction(int(size.p), int(size.q)), Fraction(0)
            stages.append(Stage(length, none) if kind == "kick" else Stage(none, length))
        return cls(tuple(stages), separable=True)

    def changes(self, outer: StepAlgebra[Any]) -> list[Any]:
        """Return z' − z; of each stage's equations those are solved that the stage itself reads."""
        result = [outer.nothing] * outer.size
        for stage in self.stages:
            half = outer.size // 2
            # A stage at (p', q) reads only the new momenta, so that n equations suffice; one at z
            # needs none.
            count = outer.size if stage.at_q else half if stage.at_p else 0
            right = partial(_stage_moves, stage, result)
            solution = outer.solve(count, partial(right, count)) if count else []
            moves = right(outer.size, outer, solution)
            result = [
                outer.add_share(x, y, Fraction(1)) for x, y in zip(result, moves, strict=True)
            ]
        return result

    def conditions(self) -> tuple[Condition, ...]:
        """Return det A = det B for each stage: together they suffice for det J ≡ 1."""
        return tuple(
            Condition(
                f"A J = B with det A = det B = {b}", 0, str(a - b), a == b and not a.is_zero()
            )
            for a, b in self.determinants()
        )

    def determinants(self) -> list[tuple[Poly, Poly]]:
        """Return (det A, det B) of each stage, where A J = B by implicit differentiation.

        The polynomials are in h and in a, b, c = H_pp, H_pq, H_qq at the stage's point (P, Q), as
        free variables. If both are the same polynomial, det J = 1 wherever det A ≠ 0: there the
        stage has a solution that depends smoothly on (p, q).
        """
        names = ("h", "a", "b", "c")
        h, a, b, c = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex).gens()
        if self.separable:
            b = b * 0
        pairs = []
        for stage in self.stages:
            at_p, at_q, kick, drift = map(_exact, (stage.at_p, stage.at_q, stage.kick, stage.drift))
            # dp' = dp − h kick (b dP + c dQ), dq' = dq + h drift (a dP + b dQ)
            slopes = (-h * kick * b, -h * kick * c), (h * drift * a, h * drift * b)
            pairs.append((_det(slopes, -at_p, -at_q), _det(slopes, 1 - at_p, 1 - at_q)))
        return pairs


def _det(slopes: Sequence[Sequence[Poly]], of_p: flint.fmpq, of_q: flint.fmpq) -> Poly:
    """Return det(1 + slopes · diag(of_p, of_q))."""
    (a, b), (c, d) = ((x * of_p, y * of_q) for x, y in slopes)
    return (1 + a) * (1 + d) - b * c


def _exact(x: Fraction) -> flint.fmpq:
    return flint.fmpq(x.numerator, x.denominator)


def _stage_moves(
    stage: Stage,
    before: Sequence[Any],
    count: int,
    algebra: StepAlgebra[Any],
    change: Sequence[Any],
) -> list[Any]:
    """Return the first `count` increments of a stage, h times its weights times its slopes.

    `before`: the change of z up to the stage. `change`: the stage's own change, or those of its
    first entries that the stage reads; the stage's point is at a share of it.
    """
    n = algebra.size // 2
    # The first n coordinates are momenta, which the kick changes; the others the drift.
    m = algebra.size - n
    shares, weights = [stage.at_p] * n + [stage.at_q] * m, [stage.kick] * n + [stage.drift] * m
    triples = zip(before, change, shares, strict=False)
    stage_point = [*(algebra.add_share(*triple) for triple in triples), *before[len(change) :]]
    slopes = algebra.slopes(stage_point, stage.at_q, range(count))  # t moves with q
    pairs = zip(weights, slopes, strict=False)
    return [algebra.move(algebra.nothing, [weight], [slope]) for weight, slope in pairs]
