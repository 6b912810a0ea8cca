"""Coefficients by which a step of −h undoes a step of h, for every system that the scheme takes.

- A splitting: its parts, read backwards, are the same, and so are their times: t_i + t_(n+1−i) = 1.
- A Runge–Kutta tableau, or both of a partitioned method: a_(s+1−i, s+1−j) + a_ij = b_j, and
  c_(s+1−i) + c_i = 1 (Hairer, Lubich, Wanner, Geometric Numerical Integration, theorem V.2.3).
- Stages that are solved one after the other: the adjoint of a stage at shares a of p' − p and b of
  q' − q is the stage at 1 − a and 1 − b; b is the share of h at which the stage reads the time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from verify.lazy_sympy import sympy
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.structures.structure import is_zero


def is_symmetric(coefficients: Any, timed: bool) -> bool:
    """Return True if the coefficients show it; False decides nothing.

    `coefficients`: those of a scheme for every H, or None; `timed`: of a system that depends on t.
    """
    if isinstance(coefficients, Splitting):
        kinds, sizes = zip(*coefficients.parts, strict=True)
        times = coefficients.in_time().all_times if timed else ()
        return (
            kinds == kinds[::-1]
            and _all_zero([x - y for x, y in zip(sizes, sizes[::-1], strict=True)])
            and _all_zero([x + y - 1 for x, y in zip(times, times[::-1], strict=True)])
        )
    if isinstance(coefficients, TreeConditions):
        return _is_symmetric_tableau(coefficients.tableau, timed)
    if isinstance(coefficients, StageEquations):
        stages = [_shares(stage, timed) for stage in coefficients.stages]
        return stages == [_adjoint(stage) for stage in reversed(stages)]
    return False


def _all_zero(differences: Sequence[sympy.Expr]) -> bool:
    return all(is_zero(sympy.sympify(x), ()) is True for x in differences)


def _is_symmetric_tableau(tableau: ImplicitTableau, timed: bool) -> bool:
    numbers, last = tableau.numbers, tableau.stages - 1
    gaps = [
        block.matrix[last - i][last - j] + block.matrix[i][j] - block.weights[j]
        for block in numbers.blocks
        for i in range(last + 1)
        for j in range(last + 1)
    ]
    gaps += [x + y - 1 for x, y in zip(numbers.clock, numbers.clock[::-1], strict=True)]
    if timed:  # a stage without a clock is at its row's sum, and the sum of two rows is Σ b_j
        gaps.append(sum(numbers.b, numbers.ring.zero) - 1)
    return all(numbers.ring.vanishes(numbers.ring.reduce(x)) is True for x in gaps)


_Shares = tuple[Any, Any, Any, Any]


def _shares(stage: Stage, timed: bool) -> _Shares:
    """Return the kick, the drift and the shares of a stage; None for a share of nothing."""
    at_p = stage.at_p if stage.kick else None
    at_q = stage.at_q if stage.drift or timed else None
    return stage.kick, stage.drift, at_p, at_q


def _adjoint(shares: _Shares) -> _Shares:
    kick, drift, at_p, at_q = shares
    return kick, drift, None if at_p is None else 1 - at_p, None if at_q is None else 1 - at_q
