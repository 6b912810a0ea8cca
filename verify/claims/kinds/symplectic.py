"""S = JᵀΩJ − Ω ≡ 0; or, if `symplectic` is false, not so. In the plane that is det J ≡ 1."""

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import Field

from verify.claims.base_claim import Claim, Findings
from verify.claims.orders import judge_vanishing, order_of
from verify.claims.quantified_claims import OF_S, marks_for_scene
from verify.prose import Prose
from verify.scenes.results.claim import ClaimResult


class SymplecticClaim(Claim):
    """The map preserves the symplectic form exactly, or does not."""

    kind: Literal["symplectic"]
    symplectic: Annotated[bool, Field(strict=True)]
    """True if S ≡ 0 is claimed, false if the opposite is."""

    def judge(self, findings: Findings) -> ClaimResult:
        """Judge by the proof for the scene's H."""
        return judge_vanishing(self, order_of(self, findings, "S"), self.symplectic)

    def checked_by(self, result: ClaimResult, findings: Findings) -> Sequence[Prose]:
        return marks_for_scene(self, findings, OF_S)


CLAIM = SymplecticClaim
