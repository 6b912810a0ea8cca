"""S = JᵀΩJ − Ω = c h^order + …, c not the zero form; with `at_least`, S = O(h^order)."""

from typing import Literal

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.formulas import within
from verify.claims.orders import Order, defect_of
from verify.scenes.results.claim import ClaimResult


class DefectOrderClaim(Claim):
    """The order of S in h; in the plane that of ΔJ."""

    kind: Literal["defect_order"]
    defect_order: Order
    """The first power of h in S."""
    at_least: bool = False
    """Whether a higher order is as claimed, too."""

    def judge(self, findings: Findings) -> ClaimResult:
        """By the proof for the scene's H."""
        known = defect_of(self, findings)
        verdict = known.verdict(self.defect_order, at_least=self.at_least)
        domain = known.holds_in(self.defect_order, at_least=self.at_least)
        return self.result(verdict, known.evidence + within(domain), domain=domain)


CLAIM = DefectOrderClaim
