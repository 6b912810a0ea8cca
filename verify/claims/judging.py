"""Claims and what was found for them → verdicts, asking for more where that may decide one.

What claims need computed, and nothing else: the tasks of their runs and proofs.

What algebra decides on the spot needs no task. Where a proof gives what a claim asks of a run,
that run is not made.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import compress
from operator import not_

from verify.claims.claim import Claim
from verify.claims.file import ClaimsFile
from verify.claims.findings import Findings
from verify.errors import InputError, LimitError, is_meant, nearest
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.prose import prose
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.statement import StatementResult, statements_of
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
            found = claim.judge(Findings(scenes, results_for(claim, scenes, store, where)))
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


def results_for(
    claim: Claim, scenes: Mapping[str, Scene], store: Store, where: Placement
) -> dict[str, Frozen]:
    """What the claim needs, by the tasks' keys."""
    plan = Plan()
    known = add_claims(plan, [claim], scenes)
    return {**known, **execute(plan, store, where=where)}


# -- the claims of a file --------------------------------------------------------------------------


@dataclass(frozen=True)
class Check:
    """The claims of a file that are to be checked, and the plan of what they need."""

    file: ClaimsFile
    claims: tuple[Claim, ...]
    plan: Plan
    known: dict[str, Frozen]

    def run(
        self, store: Store, *, where: Placement = ANYWHERE, done: OnResult | None = None
    ) -> list[ClaimResult]:
        """Each claim's verdict, in their order. InputError names the claim and its line.

        What algebra decides comes first: a formula that turns out to be none costs no run.
        """
        found: dict[str, ClaimResult] = {}
        exact = [claim.exact for claim in self.claims]
        for claim in compress(self.claims, exact):
            found[claim.id] = self._judge(claim, {}, store, where)
        results = execute(self.plan, store, where=where, done=done)
        for claim in compress(self.claims, map(not_, exact)):
            found[claim.id] = self._judge(claim, {**self.known, **results}, store, where)
        return [found[claim.id] for claim in self.claims]

    def statements(self, found: Sequence[ClaimResult]) -> tuple[StatementResult, ...]:
        """The statements all of whose readings are among the claims that are checked."""
        chosen = {claim.id for claim in self.claims}
        missing = {claim.reading_of for claim in self.file.claims if claim.id not in chosen}
        return tuple(each for each in statements_of(found) if each.id not in missing)

    def _judge(
        self, claim: Claim, results: Mapping[str, Frozen], store: Store, where: Placement
    ) -> ClaimResult:
        try:
            return judged(claim, self.file.scenes, results, store, where)
        except InputError as error:
            index = self.file.claims.index(claim)
            raise self.file.located(index, claim.id, error) from None


def prepare(file: ClaimsFile, only: Sequence[str] = ()) -> Check:
    """All claims of the file, or those whose ids `only` names; `eq-*` names several.

    Raises InputError for a name that no claim has.
    """
    for wanted in only:
        if not any(_named(claim, wanted) for claim in file.claims):
            names = [claim.id for claim in file.claims]
            meant = is_meant(nearest(wanted.lower(), names))
            problem = f"no claim has this id; {meant}there are: {', '.join(names)}"
            raise InputError("--only", wanted, problem)
    chosen = [c for c in file.claims if not only or any(_named(c, name) for name in only)]
    plan = Plan()
    known = add_claims(plan, chosen, file.scenes)
    return Check(file, tuple(chosen), plan, known)


def _named(claim: Claim, wanted: str) -> bool:
    return claim.id == wanted or fnmatchcase(claim.id, wanted)
