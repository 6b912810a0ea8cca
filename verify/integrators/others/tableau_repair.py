"""Whether two entries of one row of a tableau would make its claimed order right: a misprint."""

from itertools import combinations

import sympy

from verify.integrators.others.tableau import order_of
from verify.schemes.implicit_tableau import ImplicitTableau


def repair(tableau: ImplicitTableau, order: int) -> str:
    """A sentence that names the two entries, their sum kept, and what they would have to be.

    "" where no such pair makes it that order, or several do. Of rational coefficients.
    """
    numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
    if not all(x.is_Rational for x in numbers):
        return ""
    found = []
    for i in range(tableau.stages):
        for j, k in combinations(range(i), 2):
            changed = _changed(tableau, i, j, k)
            if changed is not None and order_of(changed, order).order >= order:
                found.append((i, j, k, changed))
    if len(found) != 1:
        return ""
    ((i, j, k, changed),) = found
    before, after = tableau.rows[i], changed.rows[i]
    return (
        f"With a_{i + 1}{j + 1}, a_{i + 1}{k + 1} = {after[j]}, {after[k]} in place of "
        f"{before[j]}, {before[k]} its order is {order}"
    )


def _changed(tableau: ImplicitTableau, i: int, j: int, k: int) -> ImplicitTableau | None:
    """With a_ij + t and a_ik − t, t such that b·A(c) = 1/6; c stays as it is."""
    c = [sum(row, sympy.S.Zero) for row in tableau.rows]
    ac = [sum((a * x for a, x in zip(row, c, strict=True)), sympy.S.Zero) for row in tableau.rows]
    gap = sum((b * x for b, x in zip(tableau.weights, ac, strict=True)), sympy.S.Zero)
    slope = tableau.weights[i] * (c[j] - c[k])
    if slope == 0:
        return None
    t = (sympy.Rational(1, 6) - gap) / slope
    if t == 0:
        return None
    rows = [list(row) for row in tableau.rows]
    rows[i][j], rows[i][k] = rows[i][j] + t, rows[i][k] - t
    return ImplicitTableau.of(rows, tableau.weights)
