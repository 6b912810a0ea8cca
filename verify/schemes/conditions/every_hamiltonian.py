"""A scheme as it is for every H: what gives its step map where H is not known.

`taylor(jets, most)`: the coefficients of h⁰ … h^most of z', as series over the jets, in as many
degrees of freedom as these have.
`StageEquations` have more: their equations, which give det J without solving them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, ClassVar, Protocol, TypeVar, runtime_checkable

import flint

from verify.algebra.series.jets import JetsInDegrees, Poly, Series
from verify.hamiltonians.jet_flow import JetFlow
from verify.late import sympy
from verify.prose import count
from verify.schemes.conditions.condition import Condition
from verify.schemes.steps.step_algebra import StepAlgebra, series_of

At = TypeVar("At")
Slope = TypeVar("Slope")


@runtime_checkable
class BySeries(Protocol):
    """A scheme for every H (`separable`: every H = T(p) + V(q)) that has a Taylor series.

    Not to be named Generic: `typing` passes over a protocol of that name, and all would be one.
    """

    @property
    def separable(self) -> bool: ...

    def taylor(self, jets: JetsInDegrees, most: int) -> tuple[Series, ...]: ...


class ByChanges(ABC):
    """A scheme whose step is made of the operations of a step, and so its series."""

    @abstractmethod
    def changes(self, algebra: StepAlgebra[Any]) -> list[Any]:
        """z' − z."""

    def taylor(self, jets: JetsInDegrees, most: int) -> tuple[Series, ...]:
        """z' as series up to h^most; see `BySeries`."""
        state = series_of(JetFlow.over(jets), self.changes, most)
        return tuple(list(x.coefficients) for x in state)


@dataclass(frozen=True)
class TaylorSeries(ByChanges):
    """The exact flow's series, cut off after h^eta (Eq. 2)."""

    eta: int
    separable: bool = False
    kind: ClassVar[str] = "taylor-series"  # the file of `verify.schemes.maps.kinds`

    @property
    def a_step(self) -> str:
        """What it costs, in words."""
        return f"derivatives of p and q along the flow, up to X^{self.eta}"

    def changes(self, algebra: StepAlgebra[Any]) -> list[Any]:
        """z' − z, by the flow's own terms."""
        return algebra.along_flow(self.eta)


@dataclass(frozen=True)
class RungeKutta(ByChanges):
    """An explicit Runge–Kutta method: k_i = f(z + h Σ a_ij k_j), j < i, and z' = z + h Σ b_i k_i.

    `rows[i]`: a_ij for j < i, which has as many entries as there are stages before; `weights`:
    b_i. ValueError where they do not fit together, or Σ b_i ≠ 1.
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
        """Those of H_p and of H_q in a step."""
        return dict.fromkeys(("H_p", "H_q"), len(self.weights))

    @property
    def a_step(self) -> str:
        """What it costs, in words."""
        return count(len(self.weights), "stage")

    def step(
        self,
        slope: Callable[[At], Slope],
        moved: Callable[[Sequence[Fraction], Sequence[Slope]], At],
    ) -> At:
        """One step: `slope` is f, and `moved(weights, slopes)` is z + h Σ weights · slopes."""
        slopes: list[Slope] = []
        for row in self.rows:
            slopes.append(slope(moved(row, slopes)))
        return moved(self.weights, slopes)

    def changes(self, algebra: StepAlgebra[Any], standing: Fraction | None = None) -> list[Any]:
        """z' − z, stage by stage, each at t + c h where H depends on time, or all at t + `standing`
        h."""
        places = range(algebra.size)

        def moved(
            weights: Sequence[Fraction], slopes: Sequence[list[Any]]
        ) -> tuple[list[Any], Fraction]:
            """A change of z, and that of t by h."""
            columns = [[slope[k] for slope in slopes] for k in places]
            own = [algebra.moved(algebra.nothing, weights, column) for column in columns]
            return own, sum(weights, Fraction(0))

        def slope(stage: tuple[list[Any], Fraction]) -> list[Any]:
            change, clock = stage
            return algebra.slopes(change, clock if standing is None else standing, places)

        return self.step(slope, moved)[0]


@dataclass(frozen=True)
class Stage:
    """p' = p − h·kick·H_q(P, Q), q' = q + h·drift·H_p(P, Q), where P = p + at_p·(p' − p) and
    Q = q + at_q·(q' − q)."""

    kick: Fraction
    drift: Fraction
    at_p: Fraction = Fraction(0)
    at_q: Fraction = Fraction(0)


@dataclass(frozen=True)
class StageEquations(ByChanges):
    """One stage after the other."""

    stages: tuple[Stage, ...]
    separable: bool = False
    kind: ClassVar[str] = "stage-equations"

    @property
    def a_step(self) -> str:
        """What it costs, in words."""
        return f"{count(len(self.stages), 'stage')}, solved by Newton's method"

    @classmethod
    def of_shears(cls, parts: Sequence[tuple[str, sympy.Rational]]) -> StageEquations:
        """Kicks and drifts of so many step sizes, for H = T(p) + V(q)."""
        stages = []
        for kind, size in parts:
            length, none = Fraction(int(size.p), int(size.q)), Fraction(0)
            stages.append(Stage(length, none) if kind == "kick" else Stage(none, length))
        return cls(tuple(stages), separable=True)

    def changes(self, outer: StepAlgebra[Any]) -> list[Any]:
        """z' − z: of each stage the change that it makes is solved for, as far as it reads it."""
        result = [outer.nothing] * outer.size
        for stage in self.stages:
            half = outer.size // 2
            count = outer.size if stage.at_q else half if stage.at_p else 0
            right = partial(_moves, stage, result)
            solved = outer.solved(count, partial(right, count)) if count else []
            moves = right(outer.size, outer, solved)
            result = [outer.between(x, y, Fraction(1)) for x, y in zip(result, moves, strict=True)]
        return result

    def conditions(self) -> tuple[Condition, ...]:
        """det A = det B of each stage, which together suffice for det J ≡ 1."""
        return tuple(
            Condition(
                f"A J = B with det A = det B = {b}", 0, str(a - b), a == b and not a.is_zero()
            )
            for a, b in self.determinants()
        )

    def determinants(self) -> list[tuple[Poly, Poly]]:
        """(det A, det B) of each stage, where A J = B by implicit differentiation.

        Over Q[h, a, b, c] with a, b, c = H_pp, H_pq, H_qq at the stage's own point (P, Q), which
        are free. Where both are the same polynomial det J = 1, wherever the stage has a solution
        that depends smoothly on (p, q), which is where det A ≠ 0.
        """
        names = ("h", "a", "b", "c")
        h, a, b, c = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex).gens()
        if self.separable:
            b = b * 0
        found = []
        for stage in self.stages:
            at_p, at_q, kick, drift = map(_exact, (stage.at_p, stage.at_q, stage.kick, stage.drift))
            # dp' = dp − h kick (b dP + c dQ), dq' = dq + h drift (a dP + b dQ)
            slopes = (-h * kick * b, -h * kick * c), (h * drift * a, h * drift * b)
            found.append((_det(slopes, -at_p, -at_q), _det(slopes, 1 - at_p, 1 - at_q)))
        return found


def _det(slopes: Sequence[Sequence[Poly]], of_p: flint.fmpq, of_q: flint.fmpq) -> Poly:
    """Of 1 + slopes, whose columns are taken times these."""
    (a, b), (c, d) = ((x * of_p, y * of_q) for x, y in slopes)
    return (1 + a) * (1 + d) - b * c


def _exact(x: Fraction) -> flint.fmpq:
    return flint.fmpq(x.numerator, x.denominator)


def _moves(
    stage: Stage,
    before: Sequence[Any],
    count: int,
    algebra: StepAlgebra[Any],
    change: Sequence[Any],
) -> list[Any]:
    """h times the first slopes that a stage takes, so many, at a share of the change that they make
    as far as that is known."""
    n = algebra.size // 2
    shares, weights = [stage.at_p] * n + [stage.at_q] * n, [stage.kick] * n + [stage.drift] * n
    moved = zip(before, change, shares, strict=False)
    at = [*(algebra.between(*each) for each in moved), *before[len(change) :]]
    slopes = algebra.slopes(at, stage.at_q, range(count))  # t goes with q
    each = zip(weights, slopes, strict=False)
    return [algebra.moved(algebra.nothing, [w], [slope]) for w, slope in each]
