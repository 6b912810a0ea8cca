"""Claims and findings → verdicts, each claim by the check of its kind."""

from collections.abc import Sequence

from verify import (
    area_claims,
    exact_claims,
    flow_claims,
    growth_claims,
    measured_claims,
    printed_claims,
)
from verify.claims import Claim, CriteriaClaim, TheoremClaim
from verify.every_claims import check_every
from verify.findings import Checks, Findings, result
from verify.results import ClaimResult
from verify.verdict import Verdict


def check_claims(claims: Sequence[Claim], findings: Findings) -> list[ClaimResult]:
    """Each claim's verdict, in their order. Raises InputError where a scene or a run is missing."""
    return [check_claim(claim, findings) for claim in claims]


def check_claim(claim: Claim, findings: Findings) -> ClaimResult:
    """The claim's verdict with its evidence."""
    if getattr(claim, "every", None):
        return check_every(claim)
    return _CHECKS[type(claim)](claim, findings)


def _check_criteria(claim: CriteriaClaim, findings: Findings) -> ClaimResult:
    scene = findings.scene(claim.scene)
    judged = [findings.criterion(scene, claim.scheme, n) for n in claim.numbers]
    verdicts = [c.verdict for c in judged]
    evidence = "; ".join(f"criterion {c.number}: {c.evidence}" for c in judged)
    if Verdict.REFUTED in verdicts:
        return result(claim, Verdict.REFUTED, evidence)
    if Verdict.UNDECIDED in verdicts:
        return result(claim, Verdict.UNDECIDED, evidence)
    weakest = Verdict.MEASURED if Verdict.MEASURED in verdicts else Verdict.PROVED
    return result(claim, weakest, evidence)


def _check_theorem(claim: TheoremClaim, _: Findings) -> ClaimResult:
    from verify.theorems import check_theorem

    found = check_theorem(claim.name)
    return result(claim, found.verdict, found.evidence, found.details, found.proof)


_CHECKS: Checks = {
    TheoremClaim: _check_theorem,
    CriteriaClaim: _check_criteria,
    **exact_claims.CHECKS,
    **area_claims.CHECKS,
    **measured_claims.CHECKS,
    **printed_claims.CHECKS,
    **growth_claims.CHECKS,
    **flow_claims.CHECKS,
}
