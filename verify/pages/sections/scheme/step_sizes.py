"""The cost of a step size in area: |Λ| and MSE/|Λ| over h."""

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import scheme_plots
from verify.pages.sections.section import Picture, Section
from verify.pages.text import words
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> tuple[Plot, ...]:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    return tuple(scheme_plots.against_step_size(runs, scene, proof, name=anchor))


SECTION = Section(
    order=40,
    view=_view,
    pictures=lambda plots: [Picture((0,), plots[0])],
    terms=lambda _: words.RAN,
    shows="runs",
    matching_plots=lambda plots, _: ((plot, "") for plot in plots),
)
