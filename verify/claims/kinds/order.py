"""The old name of `defect_order`, which some take for a method's order; each result warns of that.

In n degrees of freedom it is the order of det J − 1, and not of S.
"""

from typing import Literal

from verify.claims.orders import Order, OrderedClaim, ProvedOrder
from verify.claims.quantified_claims import OF_DELTA_J
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult

AMBIGUOUS = (
    "here order is that of det J − 1, not the method's: write defect_order (of ΔJ; of S in several "
    "degrees of freedom), or convergence_order (the method's)"
)


class OrderClaim(OrderedClaim):
    """The order of ΔJ in h."""

    warning = AMBIGUOUS
    about = OF_DELTA_J
    form = "ΔJ"

    kind: Literal["order"]
    order: Order
    """The first power of h in ΔJ; better written as a `defect_order`."""

    def judge_proved(self, proved_order: ProvedOrder) -> ClaimResult:
        result = super().judge_proved(proved_order)
        return result.model_copy(update={"evidence": prose(result.evidence, "; ", AMBIGUOUS)})


CLAIM = OrderClaim
