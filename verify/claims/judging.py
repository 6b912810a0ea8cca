"""Claims and what was found for them → verdicts, asking for more where that may decide one."""

from collections.abc import Iterable, Mapping

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.plan import add_claims
from verify.errors import InputError, LimitError
from verify.execution.execute import Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.prose import prose
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.verdict import Verdict


def judged(
    claim: Claim,
    scenes: Mapping[str, Scene],
    results: Mapping[str, Frozen],
    store: Store,
    where: Placement = ANYWHERE,
) -> ClaimResult:
    """The claim's verdict; UNDECIDED where it is beyond what is handled exactly.

    Where what was found leaves it open and the claim has a closer look to take, that is taken.
    Raises InputError where a scene or a run is missing.
    """
    try:
        found = claim.judge(Findings(scenes, results))
        while found.verdict is Verdict.UNDECIDED:
            closer = claim.closer(scenes[claim.scene]) if claim.scene in scenes else None
            if closer is None:
                break
            scenes = {**scenes, claim.scene: closer}
            found = claim.judge(Findings(scenes, _found(claim, scenes, store, where)))
    except LimitError as error:
        return claim.result(Verdict.UNDECIDED, prose(str(error)))
    return _marked(claim, found, Findings(scenes, results))


def _marked(claim: Claim, found: ClaimResult, findings: Findings) -> ClaimResult:
    """With who checked its proof; without, where nobody did, or it is too large for that."""
    if found.verdict not in (Verdict.PROVED, Verdict.REFUTED) or found.checked_by:
        return found
    try:
        return found.model_copy(update={"checked_by": tuple(claim.checked_by(found, findings))})
    except InputError:
        return found


def _found(
    claim: Claim, scenes: Mapping[str, Scene], store: Store, where: Placement
) -> dict[str, Frozen]:
    plan = Plan()
    known = add_claims(plan, [claim], scenes)
    return {**known, **execute(plan, store, where=where)}


def all_judged(
    claims: Iterable[Claim],
    scenes: Mapping[str, Scene],
    results: Mapping[str, Frozen],
    store: Store,
    where: Placement = ANYWHERE,
) -> tuple[ClaimResult, ...]:
    """The verdicts in their order; see `judged`."""
    return tuple(judged(claim, scenes, results, store, where) for claim in claims)
