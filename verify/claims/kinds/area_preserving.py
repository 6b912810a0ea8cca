"""det J ≡ 1; or, if `area_preserving` is false, not so."""

from typing import Annotated, Literal

from pydantic import Field

from verify.claims.base_claim import Findings
from verify.claims.orders import judge_vanishing, order_of, vanishing_verdict
from verify.claims.quantified_claims import OF_DELTA_J, QuantifiedClaim
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.scenes.results.claim import ClaimResult


class AreaClaim(QuantifiedClaim):
    """The map preserves area exactly, or does not."""

    about = OF_DELTA_J

    kind: Literal["area_preserving"]
    area_preserving: Annotated[bool, Field(strict=True)]
    """True if det J ≡ 1 is claimed, false if the opposite is."""

    def judge_one(self, findings: Findings) -> ClaimResult:
        return judge_vanishing(self, order_of(self, findings, "ΔJ"), self.area_preserving)

    def judge_every(self, proof: ProofForEveryH) -> ClaimResult:
        verdict = vanishing_verdict(proof.area_preserving, self.area_preserving)
        return self.result(verdict, proof.reason, domain=proof.domain)

    def why_not_transferable(self) -> str:
        if self.every and not self.area_preserving:
            return "that not every Hamiltonian has det J ≡ 1 says nothing of a single one"
        return ""


CLAIM = AreaClaim
