"""S = JᵀΩJ − Ω = c h^order + …, c not the zero form; with `at_least`, S = O(h^order)."""

from collections.abc import Sequence
from typing import Literal

from verify.claims.checked import of_scene
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.formulas import within
from verify.claims.orders import OF_S, Order, defect_of
from verify.prose import Prose
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

    def checked_by(self, found: ClaimResult, findings: Findings) -> Sequence[Prose]:
        return of_scene(self, findings, OF_S)


CLAIM = DefectOrderClaim
