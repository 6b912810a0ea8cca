"""Claims and findings → verdicts, each claim by the check of its kind."""

from collections.abc import Sequence

from verify.claims import area, formulas, growth, measured, printed, regions
from verify.claims.every_hamiltonian import check_every
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import Claim, CriteriaClaim, TheoremClaim
from verify.scenes.results.claim import ClaimResult
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
    from verify.claims.theorems import check_theorem

    found = check_theorem(claim.name)
    return result(claim, found.verdict, found.evidence, found.details, found.proof)


_CHECKS: Checks = {
    TheoremClaim: _check_theorem,
    CriteriaClaim: _check_criteria,
    **formulas.CHECKS,
    **area.CHECKS,
    **measured.CHECKS,
    **printed.CHECKS,
    **growth.CHECKS,
    **regions.CHECKS,
}
