"""`defect_order` by its old name, which others take for a method's order: each says what it is.

In n degrees of freedom it is the order of det J − 1, and not of S.
"""

from typing import TYPE_CHECKING, Literal

from verify.claims.findings import Findings
from verify.claims.orders import (
    OF_DELTA_J,
    Order,
    OrderedClaim,
    ProvedOrder,
    delta_j_of,
    every_delta_j,
)
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof

AMBIGUOUS = (
    "here order is that of det J − 1, not the method's: write defect_order (of ΔJ; of S in several "
    "degrees of freedom), or convergence_order (the method's)"
)


class OrderClaim(OrderedClaim):
    """The order of ΔJ in h."""

    warning = AMBIGUOUS

    about = OF_DELTA_J

    kind: Literal["order"]
    order: Order
    """The first power of h in ΔJ; better written as a `defect_order`."""

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self._warned(delta_j_of(self, findings))

    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        return self._warned(every_delta_j(proof))

    def _warned(self, known: ProvedOrder) -> ClaimResult:
        found = self.judge_known(known)
        return found.model_copy(update={"evidence": prose(found.evidence, "; ", AMBIGUOUS)})


CLAIM = OrderClaim
