"""The global error is of this order in h, no higher one; with `at_least`, or of a higher one.

The map agrees with the exact flow up to h to this power.
"""

from typing import Literal

from verify.claims.findings import Findings
from verify.claims.orders import Order, OrderedClaim, ProvedOrder, flow_of, told_of
from verify.claims.quantified import OF_MAP
from verify.proof.every_proof import EveryProof
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
    def looked_at(self) -> int:
        return self.claimed

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_known(flow_of(self, findings))

    def judge_every(self, proof: EveryProof) -> ClaimResult:
        found = proof.convergence_order
        if found is None:
            return self.result(Verdict.UNDECIDED, proof.reason)
        exact = proof.convergence_decided
        evidence = prose(
            "the map agrees with the exact flow of every H up to ", Formula(f"h^{found}"),
            " and, of some, no further" if exact else "; whether further is not decided",
        )  # fmt: skip
        known = ProvedOrder(found, exact, False, evidence, proof.domain)
        return self.judge_known(told_of(known, proof.nearby))


CLAIM = ConvergenceOrderClaim
