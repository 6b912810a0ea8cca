"""A Report of results for scenes and claims: planned, executed and judged, but not rendered."""

import time
from collections.abc import Mapping, Sequence

from verify.arithmetic.exact import text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.judging import add_claims, judge_claim
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.execution.provenance import provenance
from verify.hamiltonians import systems
from verify.scenes.causes import Cause
from verify.scenes.paper_figures import PaperFigure
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.exploration import Gallery
from verify.scenes.results.report import Report, SceneResult
from verify.scenes.results.statement import Outcome, statements_of
from verify.scenes.scene import Scene
from verify.studies.plan import collect_findings, plan_scenes


def make_report(
    title: str,
    scenes: Sequence[Scene],
    claims: Sequence[Claim],
    store: Store,
    *,
    command: str,
    claim_scenes: Mapping[str, Scene] | None = None,
    causes: Sequence[Cause] = (),
    figures: Sequence[PaperFigure] = (),
    preface: Sequence[str] = (),
    not_claimed: Sequence[tuple[str, str]] = (),
    plan: Plan | None = None,
    where: Placement = ANYWHERE,
    done: OnResult | None = None,
) -> Report:
    """Compute what the scenes and claims need, and judge.

    A claim is about one of the scenes, or of `claim_scenes`, which the report does not show.
    `figures` and `preface` are passed on to the page, and so are those `causes` whose claims hold.
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
        causes=tuple(each for each in causes if _is_shown(each, verdicts)),
        figures=tuple(figures),
        preface=tuple(preface),
        left_out=(*not_claimed, *plan.left_out),
        provenance=provenance(
            command, start_time, kept=reused, computed=count, where=_where(where, count)
        ),
    )


def gallery_report(
    gallery: Gallery, command: str, start_time: float, reused: int, islands: int, where: Placement
) -> Report:
    """Build the report of a hunt, which has a gallery and nothing else."""
    longer = sum(1 for each in gallery.scenes if each.longer)
    count = islands + len(gallery.scenes) + longer - reused
    return Report(
        title=f"The worst scenes: {gallery.sentence}",
        claims=(),
        scenes=(),
        gallery=gallery,
        left_out=(),
        provenance=provenance(
            command, start_time, kept=reused, computed=count, where=_where(where, count)
        ),
    )


def _is_shown(cause: Cause, claims: Sequence[ClaimResult]) -> bool:
    """Return True if the claims that show the cause hold, and no statement it explains does."""
    holding = {each.id for each in statements_of(claims) if each.outcome is Outcome.HOLDS}
    verdicts = {claim.id: claim.verdict for claim in claims}
    return not holding & {*cause.explains} and all(
        name in verdicts and verdicts[name].holds for name in cause.shown_by
    )


def _where(where: Placement, count: int) -> str:
    return ", and a cluster" if where.cluster and count else ""


def _scene_result(scene: Scene, findings: Findings) -> SceneResult:
    exact = scene.exact_hamiltonian()
    return SceneResult(
        name=scene.name,
        title=scene.title or scene.name,
        **exact.texts,
        source=systems.get(scene.system).source if scene.system else "the user's formula",
        time=text(scene.grid.time) if scene.grid and scene.grid.time else None,
        t0=text(scene.t0),
        proofs=tuple(findings.proof(scene, scheme) for scheme in scene.schemes),
        criteria=tuple(
            findings.criterion(scene, scheme, number)
            for scheme in scene.schemes
            for number in scene.criteria
        ),
        **collect_findings(scene, findings.results),
    )
