"""A scene as the page shows it: its schemes, each with proof, criteria, figures and runs."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import scene_plots
from verify.pages.sections.run_table import RunTable, run_table
from verify.pages.text import mathml
from verify.pages.text.typography import listed, prose, sentence, whole
from verify.scenes.results.claim import CriterionResult
from verify.scenes.results.proof import EveryResult, ProofResult
from verify.scenes.results.report import SceneResult
from verify.studies.criteria import NAMES

if TYPE_CHECKING:
    from verify.pages.sections.flow_view import FlowView
    from verify.pages.sections.growth_view import GrowthView
    from verify.pages.sections.separation_view import SeparationView
    from verify.pages.sections.stability_view import StabilityView
    from verify.pages.sections.work_precision_view import WorkPrecisionView


_LONGEST_POTENTIAL = 200  # characters of a G that stands in a sentence


@dataclass(frozen=True)
class SchemeView:
    proof: ProofResult
    anchor: str
    criteria: tuple[tuple[CriterionResult, str], ...]  # each with what it asks for
    matrix: Markup | None
    leading: Markup | None
    every: EveryResult | None  # what holds for every H
    every_finding: Markup  # and that in sentences
    plots: tuple[Plot, ...]
    series: tuple[Plot, ...]
    sources: tuple[str, ...]  # what of a paper each series repeats
    runs: RunTable | None
    separation: "SeparationView | None"
    growth: "GrowthView | None"


@dataclass(frozen=True)
class SceneView:
    result: SceneResult
    anchor: str
    symbols: tuple[str, ...]  # parameters without a value
    floors: str  # a sentence on the step sizes that do not divide the time
    schemes: tuple[SchemeView, ...]
    work_precision: "WorkPrecisionView | None"
    stability: "StabilityView | None"
    flows: "FlowView | None"


def scene_view(scene: SceneResult, anchor: str) -> SceneView:
    names = mathml.free_names(scene.hamiltonian)
    return SceneView(
        result=scene,
        anchor=anchor,
        symbols=tuple(n for n in names if n not in scene.parameters),
        floors=_floors(scene),
        schemes=tuple(
            _scheme_view(scene, proof, f"scheme-{index}-of-{anchor}")
            for index, proof in enumerate(scene.proofs)
        ),
        work_precision=_work_precision(scene, anchor),
        stability=_stability(scene, anchor),
        flows=_flows(scene, anchor),
    )


def _scheme_view(scene: SceneResult, proof: ProofResult, anchor: str) -> SchemeView:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    series = [run for run in scene.series if run.scheme == proof.scheme and run.series]
    every = next((e for e in scene.every if e.scheme == proof.scheme), None)
    leading = None
    if proof.order is not None:
        leading = mathml.order_equation(proof.leading, proof.order)
    return SchemeView(
        proof=proof,
        anchor=anchor,
        criteria=tuple(
            (c, NAMES.get(c.number, "")) for c in scene.criteria if c.scheme == proof.scheme
        ),
        matrix=mathml.matrix(mathml.NAMED["J"], proof.jacobian) if proof.jacobian else None,
        leading=leading,
        every=every,
        every_finding=_every_finding(every) if every else Markup(""),
        plots=tuple(scene_plots.against_step_size(runs, scene, proof, name=anchor)),
        series=tuple(
            scene_plots.over_time(run, name=f"time-{index}-of-{anchor}")
            for index, run in enumerate(series)
        ),
        sources=tuple(run.source for run in series),
        runs=run_table(runs),
        separation=_separation(scene, proof.scheme, anchor),
        growth=_growth(scene, proof.scheme, anchor),
    )


def _every_finding(every: EveryResult) -> Markup:
    found = [sentence(every.reason)]
    if every.formula:
        found.append(sentence(f"It is {every.formula}"))
    if every.telescopes:
        found.append(Markup("Along an orbit it telescopes, for it is X·G with"))
        if every.potential and len(every.potential) < _LONGEST_POTENTIAL:
            found.append(prose(f"G = {every.potential}") + ":")
        found.append(sentence(every.why))
    elif every.telescopes is False:
        found.append(Markup("It does not telescope: {}").format(sentence(every.why)))
    return Markup(" ").join(found)


def _separation(scene: SceneResult, scheme: str, anchor: str) -> "SeparationView | None":
    """Truncation against rounding, imported only where something was separated."""
    own = [g for g in scene.separations if g.points and g.points[0].scheme == scheme]
    wide = [g for g in scene.crossovers if g.points and g.points[0].scheme == scheme]
    if not own and not wide:
        return None
    from verify.pages.sections.separation_view import separation_view

    return separation_view(own, wide, name=anchor)


def _growth(scene: SceneResult, scheme: str, anchor: str) -> "GrowthView | None":
    """The growth law of Λ, imported only where it was asked for."""
    own = [each for each in scene.growth_laws if each.law.scheme == scheme]
    if not own:
        return None
    from verify.pages.sections.growth_view import growth_view

    return growth_view(own, name=anchor, explains=scene.growth_explains)


def _stability(scene: SceneResult, anchor: str) -> "StabilityView | None":
    """How stable its schemes are, imported only where it was asked for."""
    if not (scene.stability or scene.largest_steps or scene.stability_maps):
        return None
    from verify.pages.sections.stability_view import stability_view

    return stability_view(scene, anchor)


def _work_precision(scene: SceneResult, anchor: str) -> "WorkPrecisionView | None":
    """Error against run time, imported only where it was asked for."""
    if scene.work_precision is None:
        return None
    from verify.pages.sections.work_precision_view import work_precision_view

    return work_precision_view(scene.work_precision, name=anchor)


def _flows(scene: SceneResult, anchor: str) -> "FlowView | None":
    """Regions carried by maps, imported only where there are any."""
    if not scene.flows:
        return None
    from verify.pages.sections.flow_view import flow_view

    return flow_view(scene.flows, anchor)


def _floors(scene: SceneResult) -> str:
    """Which step sizes do not divide the time, with the N that is taken instead."""
    if scene.time is None:
        return ""
    time = Fraction(scene.time)
    rest = {
        r.step_size: r.steps
        for r in (*scene.runs, *scene.series)
        if time // Fraction(r.step_size) == r.steps and r.steps * Fraction(r.step_size) != time
    }
    if not rest:
        return ""
    shown = listed(f"h = {h} gives N = {whole(n)}" for h, n in rest.items())
    return f"Where T/h is not a whole number, N is T/h rounded down: {shown}."
