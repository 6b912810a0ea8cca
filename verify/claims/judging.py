"""Claims and what was found for them → verdicts, asking for more where that may decide one.

What claims need computed, and nothing else: the tasks of their runs and proofs.

What algebra decides on the spot needs no task. Where a proof gives what a claim asks of a run,
that run is not made.
"""

from collections.abc import Iterable, Mapping, Sequence

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import InputError, LimitError
from verify.execution.execute import Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.prose import prose
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.verdict import Verdict


def add_claims(
    plan: Plan, claims: Sequence[Claim], scenes: Mapping[str, Scene]
) -> dict[str, Frozen]:
    """Adds to the plan what the claims need; returns what needs no run, by the task's key.

    A claim whose scene is not among them needs what it does without one.
    """
    known: dict[str, Frozen] = {}
    for claim in claims:
        own = scenes.get(claim.scene)
        for task in claim.tasks_without_scene() if own is None else claim.tasks(own):
            name = task.key
            found = known.get(name) or task.proved()
            if found is None:
                plan.need(task, f"claim {claim.id}")
            elif name not in plan.tasks:
                known[name] = found
                plan.leave_out(f"the run of claim {claim.id}", "a proof gives what it asks for")
    return known


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
