"""The order of a Runge–Kutta method for one H, without the Taylor series of its map.

Up to the order that the conditions on its coefficients give, the map agrees with the exact flow for
every H. What they differ by at the next power of h is Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t), over the trees
of as many vertices; where ball arithmetic encloses it away from 0 at some point, that is the order
for this H. The derivatives of H are all that is needed, at that point: no series is multiplied out,
which for an involved H takes minutes.
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import islice

import flint

from verify.algebra.enclosure import enclose, enclosed, points
from verify.algebra.series.power_series import Derivatives
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.canonical_field import CanonicalField
from verify.schemes.conditions.coloured_trees import symmetry
from verify.schemes.conditions.elementary_differentials import Differentials
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import MOST_ORDER, gaps_of

_POINTS = 8
_PRECISION = 192


def order_of(tableau: ImplicitTableau, field: CanonicalField) -> int | None:
    """The order for this H; None where no point shows what it is."""
    for order in range(1, MOST_ORDER + 1):
        gaps = gaps_of(tableau, order)
        decided = [tableau.numbers.ring.decide(x).zero for x in gaps.values()]
        if None in decided:
            return None
        if False in decided:
            return order - 1 if _differ(tableau, field, order) else None
    return None


def _differ(tableau: ImplicitTableau, field: CanonicalField, order: int) -> bool:
    """Whether map and flow differ at h^order in some point, shown by balls."""
    ring = tableau.numbers.ring
    names = [n for n in field.ring.variables if n != "h"]
    with working_precision(_PRECISION):
        shares = {
            tree: enclosed(ring, gap, {}, _PRECISION) / symmetry(tree)
            for tree, gap in gaps_of(tableau, order).items()
        }
        for point in islice(points(names), _POINTS):
            at = _AtPoint(field, point)
            differentials = Differentials(at)
            total = [flint.arb(0)] * 2
            for tree, share in shares.items():
                total = [x + share * y for x, y in zip(total, differentials.of(tree), strict=True)]
            if at.defined and any(x.is_finite() and not x.contains(0) for x in total):
                return True
    return False


class _AtPoint:
    """The derivatives of H at a point, as balls, in the jets' place."""

    def __init__(self, field: CanonicalField, point: Mapping[str, Fraction]) -> None:
        self.field, self.point, self.defined = field, point, True
        self.zero = flint.arb(0)
        self._of_p, self._of_q = (Derivatives(field.ring, x) for x in field.gradient(field.energy))
        self._known: dict[tuple[int, int], flint.arb] = {}

    def h(self, i: int, j: int, k: int = 0) -> flint.arb:
        if k:
            return self.zero
        if (i, j) not in self._known:
            x = self._of_p.partial(i - 1, j) if i else self._of_q.partial(0, j - 1)
            value = enclose(self.field.ring, x, self.point, _PRECISION)
            self.defined = self.defined and value is not None
            self._known[i, j] = flint.arb.nan() if value is None else value
        return self._known[i, j]
