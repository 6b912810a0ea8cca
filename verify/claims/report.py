"""Scenes and claims → a Report of results: plans, executes, judges. Makes no page."""

import time
from collections.abc import Mapping, Sequence

from verify.arithmetic.exact import text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.judging import add_claims, judged
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
from verify.studies.plan import found_of, plan_scenes


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

    A claim speaks of one of the scenes, or of `claim_scenes`, which the report does not show.
    `figures` and `preface` are passed on to what makes a page, and those of the `causes` whose
    claims hold; `not_claimed`, what of the paper no
    claim is of, stands with what was left out.
    """
    begun = time.perf_counter()
    plan = plan_scenes(list(scenes)) if plan is None else plan
    own = {scene.name: scene for scene in scenes}
    spoken_of = {**(claim_scenes or {}), **own}
    known = add_claims(plan, claims, spoken_of)
    before = store.taken
    results = execute(plan, store, where=where, done=done)
    kept = store.taken - before
    computed = len(plan.tasks) - kept
    findings = Findings(own, results)
    known |= results
    verdicts = tuple(judged(claim, spoken_of, known, store, where) for claim in claims)
    return Report(
        title=title,
        claims=verdicts,
        statements=statements_of(verdicts),
        scenes=tuple(_scene_result(scene, findings) for scene in scenes),
        causes=tuple(each for each in causes if _shown(each, verdicts)),
        figures=tuple(figures),
        preface=tuple(preface),
        left_out=(*not_claimed, *plan.left_out),
        provenance=provenance(
            command, begun, kept=kept, computed=computed, where=_where(where, computed)
        ),
    )


def gallery_report(
    gallery: Gallery, command: str, begun: float, kept: int, islands: int, where: Placement
) -> Report:
    """The report of a hunt of so many tasks, which has a gallery and nothing else."""
    longer = sum(1 for each in gallery.scenes if each.longer)
    computed = islands + len(gallery.scenes) + longer - kept
    return Report(
        title=f"The worst scenes: {gallery.sentence}",
        claims=(),
        scenes=(),
        gallery=gallery,
        left_out=(),
        provenance=provenance(
            command, begun, kept=kept, computed=computed, where=_where(where, computed)
        ),
    )


def _shown(cause: Cause, judged: Sequence[ClaimResult]) -> bool:
    """Whether the claims that show it hold, and nothing that it explains holds as meant."""
    holding = {each.id for each in statements_of(judged) if each.outcome is Outcome.HOLDS}
    verdicts = {claim.id: claim.verdict for claim in judged}
    return not holding & {*cause.explains} and all(
        name in verdicts and verdicts[name].holds for name in cause.shown_by
    )


def _where(where: Placement, computed: int) -> str:
    return ", and a cluster" if where.cluster and computed else ""


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
        **found_of(scene, findings.results),
    )
