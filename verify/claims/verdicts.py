"""The verdicts of claims, for the check of a file and for a report: planned, computed and judged.

Only the tasks that the claims need are planned. What algebra decides at once needs no task, and a
run whose values follow from a proof is left out. An undecided claim is judged again with more
accurate runs. A report has the results of its scenes beside the verdicts; nothing is rendered here.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import compress
from operator import not_

from verify.arithmetic.exact import text
from verify.claims.base_claim import Claim, Findings
from verify.claims.claims_file import ClaimsFile
from verify.errors import InputError, LimitError, find_nearest, format_suggestion
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import LOCAL_DEFAULT, Placement
from verify.execution.plan import Plan
from verify.execution.provenance import provenance
from verify.hamiltonians import systems
from verify.prose import prose
from verify.scenes.frozen import Frozen
from verify.scenes.paper_sections import Assumption, Cause, PaperFigure
from verify.scenes.results.claim import ClaimResult, Outcome, StatementResult, statements_of
from verify.scenes.results.exploration import Gallery
from verify.scenes.results.report import Report, SceneResult
from verify.scenes.scene import Scene
from verify.studies.tasks_of_scenes import collect_findings, plan_scenes
from verify.verdict import Verdict


def add_claims(
    plan: Plan, claims: Sequence[Claim], scenes: Mapping[str, Scene]
) -> dict[str, Frozen]:
    """Add the claims' tasks to the plan; return the results that need no run, by task key.

    A claim whose scene is not among `scenes` adds its tasks that need no scene.
    """
    results: dict[str, Frozen] = {}
    for claim in claims:
        scene = scenes.get(claim.scene)
        for task in claim.tasks_without_scene() if scene is None else claim.tasks(scene):
            name = task.key
            # Several claims share tasks; a proof is asked only once for each.
            result = results.get(name) or task.result_by_proof()
            if result is None:
                plan.need(task, f"claim {claim.id}")
            elif name not in plan.tasks:
                results[name] = result
                plan.leave_out(f"the run of claim {claim.id}", "a proof gives what it asks for")
    return results


def judge_claim(
    claim: Claim,
    scenes: Mapping[str, Scene],
    results: Mapping[str, Frozen],
    store: Store,
    where: Placement = LOCAL_DEFAULT,
) -> ClaimResult:
    """Return the claim's verdict; UNDECIDED if it exceeds a limit of exact computation.

    An undecided claim is judged again with more accurate runs as long as it proposes some.
    Raises InputError if a scene or a run is missing.
    """
    try:
        result = claim.judge(Findings(scenes, results))
        # The loop ends, as `refined_scene` returns None beyond the greatest number of digits.
        while result.verdict is Verdict.UNDECIDED:
            refined = claim.refined_scene(scenes[claim.scene]) if claim.scene in scenes else None
            if refined is None:
                break
            scenes = {**scenes, claim.scene: refined}
            result = claim.judge(Findings(scenes, results_for(claim, scenes, store, where)))
    except LimitError as error:
        return claim.result(Verdict.UNDECIDED, prose(str(error)))
    return _add_marks(claim, result, Findings(scenes, results))


def _add_marks(claim: Claim, result: ClaimResult, findings: Findings) -> ClaimResult:
    """Add to the result who checked its proof, unless nobody did or it is too large."""
    if result.verdict not in (Verdict.PROVED, Verdict.REFUTED) or result.checked_by:
        return result
    try:
        return result.model_copy(update={"checked_by": tuple(claim.checked_by(result, findings))})
    # A proof too large for marks still stands: the verdict does not depend on who checked it.
    except InputError:
        return result


def results_for(
    claim: Claim, scenes: Mapping[str, Scene], store: Store, where: Placement
) -> dict[str, Frozen]:
    """Compute the results that the claim needs, by task key."""
    plan = Plan()
    proved_results = add_claims(plan, [claim], scenes)
    return {**proved_results, **execute(plan, store, where=where)}


# -- the claims of a file --------------------------------------------------------------------------


@dataclass(frozen=True)
class ClaimsCheck:
    """The claims of a file that are to be checked, and the plan of their tasks.

    `proved_results`: results that follow from proofs, and need no run, by task key.
    """

    file: ClaimsFile
    claims: tuple[Claim, ...]
    plan: Plan
    proved_results: dict[str, Frozen]

    def run(
        self, store: Store, *, where: Placement = LOCAL_DEFAULT, done: OnResult | None = None
    ) -> list[ClaimResult]:
        """Return each claim's verdict in order. InputError names the claim and its line.

        Exact claims come first, so that a formula that cannot be parsed costs no run.
        """
        claim_results: dict[str, ClaimResult] = {}
        are_exact = [claim.exact for claim in self.claims]
        for claim in compress(self.claims, are_exact):
            claim_results[claim.id] = self._judge(claim, {}, store, where)
        results = execute(self.plan, store, where=where, done=done)
        for claim in compress(self.claims, map(not_, are_exact)):
            claim_results[claim.id] = self._judge(
                claim, {**self.proved_results, **results}, store, where
            )
        return [claim_results[claim.id] for claim in self.claims]

    def statements(self, claim_results: Sequence[ClaimResult]) -> tuple[StatementResult, ...]:
        """Return the statements all of whose readings are among the checked claims."""
        checked_ids = {claim.id for claim in self.claims}
        # A statement is judged by all of its readings; with one of them left out it has no outcome.
        missing = {claim.reading_of for claim in self.file.claims if claim.id not in checked_ids}
        return tuple(
            statement for statement in statements_of(claim_results) if statement.id not in missing
        )

    def _judge(
        self, claim: Claim, results: Mapping[str, Frozen], store: Store, where: Placement
    ) -> ClaimResult:
        try:
            return judge_claim(claim, self.file.scenes, results, store, where)
        except InputError as error:
            index = self.file.claims.index(claim)
            raise self.file.locate_error(index, claim.id, error) from None


def prepare(file: ClaimsFile, only: Sequence[str] = ()) -> ClaimsCheck:
    """Select all claims of the file, or those whose ids match `only` (`eq-*`), and plan them.

    Raises InputError for a pattern that no claim matches.
    """
    for pattern in only:
        if not any(_matches(claim, pattern) for claim in file.claims):
            names = [claim.id for claim in file.claims]
            suggestion = format_suggestion(find_nearest(pattern.lower(), names))
            problem = f"no claim has this id; {suggestion}there are: {', '.join(names)}"
            raise InputError("--only", pattern, problem)
    claims = [c for c in file.claims if not only or any(_matches(c, name) for name in only)]
    plan = Plan()
    proved_results = add_claims(plan, claims, file.scenes)
    return ClaimsCheck(file, tuple(claims), plan, proved_results)


def _matches(claim: Claim, pattern: str) -> bool:
    return claim.id == pattern or fnmatchcase(claim.id, pattern)


# -- the claims of a report ------------------------------------------------------------------------


def make_report(
    title: str,
    scenes: Sequence[Scene],
    claims: Sequence[Claim],
    store: Store,
    *,
    command: str,
    claim_scenes: Mapping[str, Scene] | None = None,
    causes: Sequence[Cause] = (),
    assumptions: Sequence[Assumption] = (),
    figures: Sequence[PaperFigure] = (),
    preface: Sequence[str] = (),
    not_claimed: Sequence[tuple[str, str]] = (),
    plan: Plan | None = None,
    where: Placement = LOCAL_DEFAULT,
    done: OnResult | None = None,
) -> Report:
    """Compute what the scenes and claims need, and judge.

    A claim is about one of the scenes, or of `claim_scenes`, which the report does not show.
    `figures`, `assumptions` and `preface` are passed on to the page, and so are those `causes`
    whose claims hold.
    `not_claimed`, the parts of the paper without a claim, is listed with what was left out.
    """
    start_time = time.perf_counter()
    plan = plan_scenes(list(scenes)) if plan is None else plan
    scenes_by_name = {scene.name: scene for scene in scenes}
    # The report's own scenes hide those of the claims with the same name.
    all_scenes = {**(claim_scenes or {}), **scenes_by_name}
    all_results = add_claims(plan, claims, all_scenes)
    # Results that were in the store before count as reused, not as computed by this report.
    before = store.taken
    results = execute(plan, store, where=where, done=done)
    reused = store.taken - before
    count = len(plan.tasks) - reused
    findings = Findings(scenes_by_name, results)
    all_results |= results
    verdicts = tuple(judge_claim(claim, all_scenes, all_results, store, where) for claim in claims)
    return Report(
        title=title,
        claims=verdicts,
        statements=statements_of(verdicts),
        scenes=tuple(_scene_result(scene, findings) for scene in scenes),
        causes=tuple(cause for cause in causes if _is_shown(cause, verdicts)),
        assumptions=tuple(assumptions),
        figures=tuple(figures),
        preface=tuple(preface),
        left_out=(*not_claimed, *plan.left_out),
        not_claimed=tuple(not_claimed),
        provenance=provenance(
            command, start_time, kept=reused, computed=count, where=_describe_cluster(where, count)
        ),
    )


def gallery_report(
    gallery: Gallery, command: str, start_time: float, reused: int, islands: int, where: Placement
) -> Report:
    """Build the report of a hunt, which has a gallery and nothing else."""
    longer = sum(1 for scene in gallery.scenes if scene.longer)
    count = islands + len(gallery.scenes) + longer - reused
    return Report(
        title=f"The worst scenes: {gallery.sentence}",
        claims=(),
        scenes=(),
        gallery=gallery,
        left_out=(),
        provenance=provenance(
            command, start_time, kept=reused, computed=count, where=_describe_cluster(where, count)
        ),
    )


def _is_shown(cause: Cause, claims: Sequence[ClaimResult]) -> bool:
    """Return True if the claims that show the cause hold, and no statement it explains does."""
    holding = {
        statement.id for statement in statements_of(claims) if statement.outcome is Outcome.HOLDS
    }
    verdicts = {claim.id: claim.verdict for claim in claims}
    return not holding & {*cause.explains} and all(
        name in verdicts and verdicts[name].holds for name in cause.shown_by
    )


def _describe_cluster(where: Placement, count: int) -> str:
    return ", and a cluster" if where.cluster and count else ""


def _scene_result(scene: Scene, findings: Findings) -> SceneResult:
    hamiltonian = scene.exact_hamiltonian()
    return SceneResult(
        name=scene.name,
        title=scene.title or scene.name,
        **hamiltonian.texts,
        source=systems.get(scene.system).source if scene.system else "the user's formula",
        time=text(scene.grid.time) if scene.grid and scene.grid.time else None,
        t0=text(scene.t0),
        proofs=tuple(
            findings.proof(scene, scheme) for scheme in scene.schemes if scene.field is None
        ),
        criteria=tuple(
            findings.criterion(scene, scheme, number)
            for scheme in scene.schemes
            for number in scene.criteria
        ),
        **collect_findings(scene, findings.results),
    )
