"""S = JᵀΩJ − Ω ≡ 0; or, where `symplectic` is false, not so. In the plane that is det J ≡ 1."""

from typing import Annotated, Literal

from pydantic import Field

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.formulas import within
from verify.claims.orders import defect_of
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


class SymplecticClaim(Claim):
    """The map preserves the symplectic form exactly, or does not."""

    kind: Literal["symplectic"]
    symplectic: Annotated[bool, Field(strict=True)]
    """Whether S ≡ 0 is claimed, or that it is not so."""

    def judge(self, findings: Findings) -> ClaimResult:
        """By the proof for the scene's H."""
        known = defect_of(self, findings)
        domain = known.domain & known.exact_for
        evidence = known.evidence + within(domain)
        if known.vanishes is None:
            return self.result(Verdict.UNDECIDED, evidence, domain=domain)
        holds = known.vanishes == self.symplectic
        return self.result(Verdict.PROVED if holds else Verdict.REFUTED, evidence, domain=domain)


CLAIM = SymplecticClaim
