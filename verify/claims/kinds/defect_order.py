"""S = JᵀΩJ − Ω = c h^order + …, c not the zero form; with `at_least`, S = O(h^order).

In the plane S is ΔJ·Ω, and this is the order of ΔJ.
"""

from typing import TYPE_CHECKING, Literal

from verify.claims.findings import Findings
from verify.claims.orders import OF_S, Order, OrderedClaim, defect_of, every_delta_j
from verify.scenes.results.claim import ClaimResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof


class DefectOrderClaim(OrderedClaim):
    """The order of S in h; in the plane that of ΔJ."""

    about = OF_S

    kind: Literal["defect_order"]
    defect_order: Order
    """The first power of h in S, or ΔJ."""

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_known(defect_of(self, findings))

    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        return self.judge_known(every_delta_j(proof))


CLAIM = DefectOrderClaim
