"""Every smooth H(p, q, t) at once: H_ijk = ∂_pⁱ∂_q^j∂_t^k H as independent variables.

As in `verify.algebra.series.jets`, at a point they may take any values, so that what vanishes for
every H is the zero polynomial. The derivative along the flow is D = ∂_t + H_p ∂_q − H_q ∂_p, and
∂_t sends H_ijk to H_ij(k+1).
"""

from collections.abc import Iterator

from verify.algebra.series.jets import JetRing
from verify.algebra.series.jets_in_degrees import Index


class TimedJets(JetRing):
    """The ring of p, q, t and H_ijk, i + j ≥ 1, i + j + k ≤ `order`; KeyError for another one."""

    def __init__(self, order: int) -> None:
        super().__init__(order, timed=True)

    def _of_order(self, n: int) -> Iterator[Index]:
        """Those by t alone occur in no derivative along the flow."""
        return ((n - k - j, j, k) for k in range(n) for j in range(n - k + 1))
