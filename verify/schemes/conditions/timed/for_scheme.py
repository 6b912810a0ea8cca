"""The conditions on a scheme's coefficients for H that depend on time, for any kind of scheme.

conditions = conditions_for(scheme.every_h, Kinetic.MASS) order, violated = agreed_order(conditions,
scheme.order) # of verify.proof.by_conditions

A scheme without specified times has the right ones. A scheme that is a series, as `lieη`, has no
coefficients to put conditions on: its order is that of the series, with D = ∂_t + X for X.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import sympy

from verify.errors import InputError
from verify.schemes.conditions.every_hamiltonian import RungeKutta, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.conditions.words.kinetic import Kinetic


def conditions_for(
    every_h: object,
    kinetic: Kinetic | None = None,
    times: Sequence[sympy.Expr | int | None] = (),
) -> Splitting | TreeConditions:
    """Return the conditions of `Scheme.every_h`, for every H = T + V(q, t) with T of the class.

    `kinetic` None: for every H(p, q, t) that the scheme takes. `times`: of each part, or of each
    stage, as parts of h; None for the right one, and without them those of the scheme itself.
    Raises InputError for what has no coefficients.
    """
    if isinstance(every_h, Splitting):
        return every_h.in_time(kinetic, tuple(times))
    if isinstance(every_h, TreeConditions):
        tableau = every_h.tableau
    elif isinstance(every_h, RungeKutta):
        count = len(every_h.weights)
        rows = [[*row, *[0] * (count - len(row))] for row in every_h.rows]
        tableau = ImplicitTableau.from_numbers(rows, every_h.weights)
    elif isinstance(every_h, StageEquations):
        tableau = _of_stages(every_h)
    else:
        raise InputError("scheme", type(every_h).__name__, "is not given by coefficients")
    of_all = Kinetic.GENERAL if every_h.separable else None
    return TreeConditions(tableau.with_times(times or None), kinetic or of_all)


def _of_stages(equations: StageEquations) -> ImplicitTableau:
    """Return the tableau of stages that are made one after the other; one part where p and q are
    alike in them."""
    of_p = _sequential_tableau([(s.kick, s.at_p) for s in equations.stages])
    of_q = _sequential_tableau([(s.drift, s.at_q) for s in equations.stages])
    return of_p if of_p == of_q else replace(of_p, of_q=of_q)


def _sequential_tableau(stages: Sequence[tuple[Fraction, Fraction]]) -> ImplicitTableau:
    """Return the tableau of z_i = z_(i−1) + h b_i f(z_(i−1) + at_i (z_i − z_(i−1)))."""
    weights = [weight for weight, _ in stages]
    rows = [
        [*weights[:i], share * weight, *[0] * (len(stages) - i - 1)]
        for i, (weight, share) in enumerate(stages)
    ]
    return ImplicitTableau.from_numbers(rows, weights)
