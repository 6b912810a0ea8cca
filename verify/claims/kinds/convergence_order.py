"""The global error has exactly this order in h, or with `at_least` this order or a higher one.

The map agrees with the exact flow up to h to this power.
"""

from typing import Literal

from verify.claims.base_claim import Findings
from verify.claims.orders import Order, OrderedClaim, ProvedOrder, flow_agreement, with_nearby
from verify.claims.quantified_claims import OF_MAP
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.prose import Formula, prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


class ConvergenceOrderClaim(OrderedClaim):
    """The order of the scheme."""

    about = OF_MAP

    kind: Literal["convergence_order"]
    convergence_order: Order
    """The order of the global error."""

    @property
    def least_order(self) -> int:
        return self.claimed_order

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_proved(flow_agreement(self, findings))

    def judge_every(self, proof: ProofForEveryH) -> ClaimResult:
        order = proof.convergence_order
        if order is None:
            return self.result(Verdict.UNDECIDED, proof.reason)
        is_exact = proof.convergence_decided
        evidence = prose(
            "the map agrees with the exact flow of every H up to ", Formula(f"h^{order}"),
            " and, of some, no further" if is_exact else "; whether further is not decided",
        )  # fmt: skip
        proved_order = ProvedOrder(order, is_exact, False, evidence, proof.domain)
        return self.judge_proved(with_nearby(proved_order, proof.nearby))


CLAIM = ConvergenceOrderClaim
