"""The conditions on a scheme's coefficients for H that depend on time, whatever kind it is of.

    conditions = conditions_for(scheme.every_h, Kinetic.MASS)
    order, violated = agreed_order(conditions, scheme.order)  # of verify.proof.by_conditions

Without times of its own a scheme has the right ones. A scheme that is a series, as `lieη`, has no
coefficients of which to ask: its order is that of the series, with D = ∂_t + X for X.
"""

from collections.abc import Sequence
from functools import singledispatch
from typing import Protocol

import sympy

from verify.errors import InputError
from verify.schemes.conditions.condition import ByConditions
from verify.schemes.conditions.every_hamiltonian import RungeKutta, StageEquations
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.timed.runge_kutta import TimedTrees
from verify.schemes.conditions.timed.splitting import TimedSplitting
from verify.schemes.conditions.timed.tableau import TimedTableau
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.conditions.words.kinetic import Kinetic

Times = Sequence[sympy.Expr | None] | None


class TimedConditions(ByConditions, Protocol):
    """Those of a scheme whose parts or stages have times."""

    @property
    def clock(self) -> list[sympy.Expr]:
        """The time of each, in parts of h."""
        ...


@singledispatch
def conditions_for(
    every_h: object, kinetic: Kinetic | None = None, times: Times = None
) -> TimedConditions:
    """Of `Scheme.every_h`, for every H = T + V(q, t) with T of the class.

    `kinetic` None: for every H(p, q, t) that the scheme takes. `times`: of each part, or of each
    stage, as parts of h; None for the right one, and without them those of the scheme itself.
    Raises InputError for what has no coefficients.
    """
    raise InputError("scheme", type(every_h).__name__, "is not given by coefficients")


@conditions_for.register
def _(every_h: Splitting, kinetic: Kinetic | None = None, times: Times = None) -> TimedConditions:
    own = times or every_h.times or (None,) * len(every_h.parts)
    near = every_h.nearby_at(own)
    return TimedSplitting(every_h.parts, tuple(own), kinetic or Kinetic.GENERAL, near)


@conditions_for.register
def _(
    every_h: TreeConditions, kinetic: Kinetic | None = None, times: Times = None
) -> TimedConditions:
    return TimedTrees(TimedTableau.of(every_h.tableau, times), _class(every_h.separable, kinetic))


@conditions_for.register
def _(every_h: RungeKutta, kinetic: Kinetic | None = None, times: Times = None) -> TimedConditions:
    tableau = TimedTableau.of_explicit(every_h, times)
    return TimedTrees(tableau, _class(every_h.separable, kinetic))


@conditions_for.register
def _(
    every_h: StageEquations, kinetic: Kinetic | None = None, times: Times = None
) -> TimedConditions:
    tableau = TimedTableau.of_stages(every_h, times)
    return TimedTrees(tableau, _class(every_h.separable, kinetic))


def _class(separable: bool, kinetic: Kinetic | None) -> Kinetic | None:
    return kinetic or (Kinetic.GENERAL if separable else None)
