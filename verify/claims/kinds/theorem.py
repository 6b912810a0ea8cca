"""What a paper says in words, judged by the function of that `name` in `verify.claims.theorems`."""

from typing import Literal, Self

from pydantic import model_validator

from verify.claims import theorems
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import unknown
from verify.scenes.results.claim import ClaimResult


class TheoremClaim(Claim):
    """A claim in words, which has neither scene nor scheme."""

    on_scene = False
    only_here = "a theorem says nothing of drawn Hamiltonians"
    kind: Literal["theorem"]
    name: str
    """The name of its function in `verify.claims.theorems`."""
    scheme: str = ""
    """None."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.name not in theorems.names():
            raise unknown("name", self.name, theorems.names())
        return self

    def judge(self, findings: Findings) -> ClaimResult:
        found = theorems.check_theorem(self.name)
        result = self.result(found.verdict, found.evidence, found.details, found.proof)
        own = {name: getattr(found, name) for name in ("checked_by", "given", "steps", "remark")}
        return result.model_copy(update=own)


CLAIM = TheoremClaim
