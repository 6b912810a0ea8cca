"""The order of a Runge–Kutta method for one H, without the Taylor series of its map.

Up to the order that the conditions on its coefficients give, the map agrees with the exact flow for
every H. At the next power of h they differ by Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t), over the trees of as
many vertices; where ball arithmetic encloses it away from 0 at some point, that is the order for
this H. Only the derivatives of H at that point are needed: no series is multiplied out, which for
an involved H takes minutes.
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import islice

import flint

from verify.algebra.enclosure import enclose, enclose_defined, points
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
    """Return the order for this H; None where no point decides it."""
    for order in range(1, MOST_ORDER + 1):
        gaps = gaps_of(tableau, order)
        decisions = [tableau.numbers.ring.decide(x).zero for x in gaps.values()]
        if None in decisions:
            return None
        if False in decisions:
            return order - 1 if _differ(tableau, field, order) else None
    return None


def _differ(tableau: ImplicitTableau, field: CanonicalField, order: int) -> bool:
    """Return True if map and flow differ at h^order in some point, shown by balls."""
    ring = tableau.numbers.ring
    names = [n for n in field.ring.variables if n != "h"]
    with working_precision(_PRECISION):
        shares = {
            tree: enclose_defined(ring, gap, {}, _PRECISION) / symmetry(tree)
            for tree, gap in gaps_of(tableau, order).items()
        }
        # One point with a nonzero difference proves it; if none shows one, nothing is concluded.
        for point in islice(points(names), _POINTS):
            jets = _AtPoint(field, point)
            differentials = Differentials(jets)
            total = [flint.arb(0)] * 2
            for tree, share in shares.items():
                total = [
                    x + share * y
                    for x, y in zip(total, differentials.differential(tree), strict=True)
                ]
            if jets.is_defined and any(x.is_finite() and not x.contains(0) for x in total):
                return True
    return False


class _AtPoint:
    """The derivatives of H at a point, as balls, in place of the jets."""

    def __init__(self, field: CanonicalField, point: Mapping[str, Fraction]) -> None:
        self.field, self.point, self.is_defined = field, point, True
        self.zero = flint.arb(0)
        self._of_p, self._of_q = (Derivatives(field.ring, x) for x in field.gradient(field.energy))
        self._cache: dict[tuple[int, int], flint.arb] = {}

    def h(self, i: int, j: int, k: int = 0) -> flint.arb:
        """Return H_ijk at the point; NaN where it may not be defined."""
        if k:
            return self.zero
        if (i, j) not in self._cache:
            x = self._of_p.partial(i - 1, j) if i else self._of_q.partial(0, j - 1)
            value = enclose(self.field.ring, x, self.point, _PRECISION)
            self.is_defined = self.is_defined and value is not None
            self._cache[i, j] = flint.arb.nan() if value is None else value
        return self._cache[i, j]
