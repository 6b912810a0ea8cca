"""What happens along a run: ΔJ and Λ over time."""

from collections.abc import Iterator

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.by_key import by_key
from verify.pages.sections.over_time_plot import over_time
from verify.pages.sections.section import Picture, Section
from verify.pages.text import words
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult

SeriesView = tuple[tuple[Plot, str], ...]  # each with what of a paper it repeats


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeriesView:
    return tuple(_plots(scene, proof, anchor))


def _plots(scene: SceneResult, proof: ProofResult, anchor: str) -> Iterator[tuple[Plot, str]]:
    """One of all that repeats the same with the same step size."""
    own = [run for run in scene.series if run.scheme == proof.scheme and run.series]
    together = by_key(own, lambda run: (run.source, run.step_size, run.arithmetic))
    for index, ((source, *_), runs) in enumerate(together.items()):
        yield over_time(runs, name=f"time-{index}-of-{anchor}"), source


SECTION = Section(
    order=50,
    view=_view,
    pictures=lambda view: [Picture((4,), plot) for plot, _ in view],
    terms=lambda _: words.RAN,
    shows="series",
    drawn=lambda view, label: ((plot, "") for plot, source in view if source == label),
)
