"""det J ≡ 1; or, where `area_preserving` is false, not so."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.claims.findings import Findings
from verify.claims.formulas import within
from verify.claims.orders import as_claimed, order_of
from verify.claims.quantified import OF_DELTA_J, QuantifiedClaim
from verify.scenes.results.claim import ClaimResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof


class AreaClaim(QuantifiedClaim):
    """The map preserves area exactly, or does not."""

    about = OF_DELTA_J

    kind: Literal["area_preserving"]
    area_preserving: Annotated[bool, Field(strict=True)]
    """Whether det J ≡ 1 is claimed, or that it is not so."""

    def judge_one(self, findings: Findings) -> ClaimResult:
        known = order_of(self, findings, "ΔJ")
        domain = known.domain & known.exact_for
        return self.judge_known(known.vanishes, known.evidence + within(domain), domain)

    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        return self.judge_known(proof.area_preserving, proof.reason, proof.domain)

    def judge_known(
        self, vanishes: bool | None, evidence: str, domain: Domain = EVERYWHERE
    ) -> ClaimResult:
        """Whether ΔJ ≡ 0 is as claimed."""
        verdict = as_claimed(vanishes, self.area_preserving)
        return self.result(verdict, evidence, domain=domain)

    def why_only_here(self) -> str:
        if self.every and not self.area_preserving:
            return "that not every Hamiltonian has det J ≡ 1 says nothing of a single one"
        return ""


CLAIM = AreaClaim
