"""ΔJ = c h^order + …, c not the zero function; with `at_least`, ΔJ = O(h^order)."""

from typing import TYPE_CHECKING, Literal

from verify.claims.findings import Findings
from verify.claims.orders import OF_DELTA_J, Order, OrderedClaim, delta_j_of
from verify.claims.proved_order import ProvedOrder
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

if TYPE_CHECKING:
    from verify.claims.checked import AboutAll
    from verify.proof.every_proof import EveryProof


class OrderClaim(OrderedClaim):
    """The order of ΔJ in h."""

    kind: Literal["order"]
    order: Order
    """The first power of h in ΔJ."""

    @property
    def claimed(self) -> int:
        return self.order

    @property
    def about(self) -> "AboutAll":
        return OF_DELTA_J

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_known(delta_j_of(self, findings))

    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        preserves, order = proof.area_preserving, proof.order
        if preserves is None and order is None:
            return self.result(Verdict.UNDECIDED, proof.reason)
        known = ProvedOrder(order or 0, order is not None, preserves, proof.reason, proof.domain)
        return self.judge_known(known)


CLAIM = OrderClaim
