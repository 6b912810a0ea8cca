"""What happens along a run: det J, ΔJ and Λ over time."""

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import scheme_plots
from verify.pages.sections.section import Picture, Section
from verify.pages.text import words
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult

SeriesView = tuple[tuple[Plot, str], ...]  # each with what of a paper it repeats


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeriesView:
    own = [run for run in scene.series if run.scheme == proof.scheme and run.series]
    return tuple(
        (scheme_plots.over_time(run, name=f"time-{index}-of-{anchor}"), run.source)
        for index, run in enumerate(own)
    )


SECTION = Section(
    order=50,
    view=_view,
    pictures=lambda view: [Picture((4,), plot) for plot, _ in view],
    terms=lambda _: words.RAN,
    shows="series",
    drawn=lambda view, label: ((plot, "") for plot, source in view if source == label),
)
