"""Scenes and claims → a Report of results: plans, executes, judges. Makes no page."""

import time
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from verify.arithmetic.exact import text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.plan import add_claims
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.keeping import machine, versions
from verify.execution.plan import Plan
from verify.hamiltonians import systems
from verify.scenes.paper_figures import PaperFigure
from verify.scenes.results.exploration import Gallery
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.proof import EveryResult
from verify.scenes.results.report import Provenance, Report, SceneResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationGrid
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.scenes.scene import Scene
from verify.studies.plan import plan_scenes, series_task
from verify.studies.proofs.every import EveryTask
from verify.studies.regions.findings import flows_of
from verify.studies.separation.separate import as_grid
from verify.studies.stability.findings import largest_steps, run_verdicts, stability_maps
from verify.studies.work_precision.plan import work_precision_task


def make_report(
    title: str,
    scenes: Sequence[Scene],
    claims: Sequence[Claim],
    store: Store,
    *,
    command: str,
    claim_scenes: Mapping[str, Scene] | None = None,
    figures: Sequence[PaperFigure] = (),
    plan: Plan | None = None,
    where: Placement = ANYWHERE,
    done: OnResult | None = None,
) -> Report:
    """Compute what the scenes and claims need, and judge.

    A claim speaks of one of the scenes, or of `claim_scenes`, which the report does not show.
    `figures` are passed on to what makes a page.
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
    of_claims = Findings(spoken_of, {**known, **results})
    return Report(
        title=title,
        claims=tuple(claim.judge(of_claims) for claim in claims),
        scenes=tuple(_scene_result(scene, findings) for scene in scenes),
        figures=tuple(figures),
        left_out=tuple(plan.left_out),
        provenance=_provenance(command, begun, kept, computed, where),
    )


def gallery_report(
    gallery: Gallery, command: str, begun: float, kept: int, islands: int, where: Placement
) -> Report:
    """The report of a hunt of so many tasks, which has a gallery and nothing else."""
    computed = islands + len(gallery.scenes) + sum(1 for each in gallery.scenes if each.longer)
    return Report(
        title=f"The worst scenes: {gallery.sentence}",
        claims=(),
        scenes=(),
        gallery=gallery,
        left_out=(),
        provenance=_provenance(command, begun, kept, computed - kept, where),
    )


def _provenance(
    command: str, begun: float, kept: int, computed: int, where: Placement
) -> Provenance:
    return Provenance(
        command=command,
        versions=versions(),
        machine=f"{machine()}, and a cluster" if where.cluster and computed else machine(),
        seconds=time.perf_counter() - begun,
        kept=kept,
        computed=computed,
    )


def _scene_result(scene: Scene, findings: Findings) -> SceneResult:
    exact = scene.exact_hamiltonian()
    return SceneResult(
        name=scene.name,
        title=scene.title or scene.name,
        **exact.texts,
        source=systems.get(scene.system).source if scene.system else "the user's formula",
        time=text(scene.grid.time) if scene.grid and scene.grid.time else None,
        proofs=tuple(findings.proof(scene, scheme) for scheme in scene.schemes),
        criteria=tuple(
            findings.criterion(scene, scheme, number)
            for scheme in scene.schemes
            for number in scene.criteria
        ),
        runs=tuple(run for scheme in scene.schemes for run in findings.runs(scene, scheme)),
        series=tuple(_series(scene, findings)),
        separations=_separations(scene, findings, own=True),
        crossovers=_separations(scene, findings, own=False),
        every=_every(scene, findings),
        growth_laws=_growth_laws(scene, findings),
        growth_explains=scene.grid.growth_explains if scene.grid else "",
        work_precision=_work_precision(scene, findings),
        flows=flows_of(scene, findings.results),
        stability=run_verdicts(scene, findings.results),
        largest_steps=largest_steps(scene, findings.results),
        stability_maps=stability_maps(scene, findings.results),
    )


def _series(scene: Scene, findings: Findings) -> Iterator[RunResult]:
    """The series that were run, each with what the scene says it repeats."""
    for scheme in scene.schemes:
        for index, asked in enumerate(scene.series):
            run = findings.results.get(series_task(scene, scheme, index).key)
            if isinstance(run, RunResult):
                yield run.model_copy(update={"source": asked.source})


def _separations(scene: Scene, findings: Findings, *, own: bool) -> tuple[SeparationGrid, ...]:
    """Those of the scene's grid, one an initial value, or those that are asked for beside it."""
    grids = [scene.grid] if own and scene.grid and scene.grid.separate else []
    if not own:
        grids = [over.as_grid() for over in scene.separation]
    found = []
    for scheme in scene.schemes:
        for grid in grids:
            results = findings.separations(scene, scheme, grid)
            width = len(grid.step_sizes)
            rows = [results[i : i + width] for i in range(0, len(results), width)]
            found += [as_grid(row) for row in rows]
    return tuple(found)


def _every(scene: Scene, findings: Findings) -> tuple[EveryResult, ...]:
    """What is proved of the scene's schemes for every H, where it was asked for."""
    found = (findings.results.get(EveryTask(scheme=name).key) for name in scene.schemes)
    return tuple(r for r in found if scene.every_hamiltonian and isinstance(r, EveryResult))


def _growth_laws(scene: Scene, findings: Findings) -> tuple[GrowthLawResult, ...]:
    """The grid's runs against the growth law, where it was asked for."""
    if scene.grid is None or not scene.grid.growth:
        return ()
    from verify.studies.growth.prediction import predictions

    exact, found = scene.exact_hamiltonian(), []
    for scheme in scene.schemes:
        runs = findings.runs(scene, scheme)
        for law in findings.growth_laws(scene, scheme):
            own = [run for run in runs if (run.q, run.p) == (law.q, law.p)]
            own.sort(key=lambda run: Fraction(run.step_size))
            found.append(GrowthLawResult(law=law, predictions=predictions(exact, law, own)))
    return tuple(found)


def _work_precision(scene: Scene, findings: Findings) -> WorkPrecisionResult | None:
    """Error against run time, where it was asked for."""
    if scene.work_precision is None:
        return None
    found = findings.results[work_precision_task(scene, scene.work_precision).key]
    assert isinstance(found, WorkPrecisionResult)  # noqa: S101 - the key is such a task's
    return found
