"""What happens along a run: ΔJ and Λ over time, in a picture with its caption.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterator, Sequence

from verify.pages.figures.captioned_plot import Plot, computed, few, plotted
from verify.pages.sections.by_key import by_key
from verify.pages.sections.section import Picture, Section
from verify.pages.text import words
from verify.pages.text.typography import start, whole
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult

SeriesView = tuple[tuple[Plot, str], ...]  # each with what of a paper it repeats


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeriesView:
    return tuple(_plots(scene, proof, anchor))


def _plots(scene: SceneResult, proof: ProofResult, anchor: str) -> Iterator[tuple[Plot, str]]:
    """One of all that repeats the same with the same step size."""
    own = [run for run in scene.series if run.scheme == proof.scheme and run.series]
    together = by_key(own, lambda run: (run.source, run.step_size, run.arithmetic))
    for index, ((source, *_), runs) in enumerate(together.items()):
        yield _over_time(runs, name=f"time-{index}-of-{anchor}"), source


def _over_time(runs: Sequence[RunResult], *, name: str) -> Plot:
    """ΔJ and Λ along runs of one step size, a row for each initial value."""
    from verify.pages.figures import over_time_figure as figure

    by_start = by_key(runs, start)
    rows = [figure.along(at, own) for at, own in by_start.items()]
    drawn = [run for row in rows for run, _ in row.panels]
    of = f" from {rows[0].label}" if len(rows) == 1 else ""
    source = f" (for {runs[0].source})" if runs[0].source else ""
    hidden = any(len(row.panels) == 1 for row in rows)
    what = "Λ" if hidden else "ΔJ = det J − 1 and Λ"
    said = [
        _bands(max(p.last - p.first + 1 for run in drawn for p in figure.merged(run.series))),
        "ΔJ goes up and down within each band, so that its picture would be a rectangle." * hidden,
        *(each for at, own in by_start.items() for each in _ends(own, at if not of else "")),
        computed(drawn),
    ]
    return plotted(
        lambda: figure.draw_over_time(rows),
        name=name,
        lead=f"{what} over time, h = {runs[0].step_size}{of}{source}",
        caption=" ".join(filter(None, said)),
    )


def _bands(steps: int) -> str:
    if steps == 1:
        return "Each level is one step."
    return (
        f"Each band reaches from the least to the greatest value within up to {whole(steps)} steps."
    )


def _ends(runs: Sequence[RunResult], label: str) -> Iterator[str]:
    """What the longest run ends with."""
    run = max(runs, key=lambda each: each.steps)
    where = f"From {label}: the" if label else "The"
    if run.status == "left range":
        yield f"{where} run left the range of {run.arithmetic} before its {whole(run.steps)} steps."
    elif {"delta_j_max", "lambda"} <= set(run.values):
        top, end = (few(run.values[key].value) for key in ("delta_j_max", "lambda"))
        yield f"{where} greatest |ΔJ| is {top}; after {whole(run.steps)} steps Λ is {end}."


SECTION = Section(
    order=50,
    view=_view,
    pictures=lambda view: [Picture((4,), plot) for plot, _ in view],
    terms=lambda _: words.RAN,
    shows="series",
    drawn=lambda view, label: ((plot, "") for plot, source in view if source == label),
)
