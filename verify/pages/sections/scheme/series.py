"""ΔJ and Λ along runs, over time: a picture with its caption.

The drawing, and with it matplotlib, is imported only if something is drawn.
"""

from collections.abc import Iterator, Sequence

from verify.pages.figures.captioned_plot import (
    Plot,
    captioned_plot,
    describe_runs,
    round_to_few_digits,
)
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.sections.table_rows import by_key
from verify.pages.text import legend
from verify.pages.text.typography import start, whole
from verify.scenes.frozen import OfScheme
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult

# Plots, each with the part of a paper that it repeats.
SeriesView = tuple[tuple[Plot, str], ...]


def _view(scene: SceneResult, proof: OfScheme, anchor: str) -> SeriesView:
    return tuple(_plots(scene, proof, anchor))


def _plots(scene: SceneResult, proof: OfScheme, anchor: str) -> Iterator[tuple[Plot, str]]:
    """Yield a plot for all runs with the same step size that repeat the same part of a paper."""
    # Where a proof gives Λ, ΔJ and Λ are lines at 0; such a series is there for its energy.
    scheme_series = [
        run
        for run in scene.series
        if run.scheme == proof.scheme and run.series and "lambda" not in run.exact
    ]
    groups = by_key(scheme_series, lambda run: (run.source, run.step_size, run.arithmetic))
    for index, ((source, *_), runs) in enumerate(groups.items()):
        yield _over_time(runs, name=f"time-{index}-of-{anchor}"), source


def _over_time(runs: Sequence[RunResult], *, name: str) -> Plot:
    """Return the plot of ΔJ and Λ along runs of one step size, a row for each initial value."""
    from verify.pages.figures import over_time_figure as figure

    by_start = by_key(runs, start)
    rows = [figure.select_panels(start_text, group) for start_text, group in by_start.items()]
    drawn_runs = [run for row in rows for run, _ in row.panels]
    origin = f" from {rows[0].label}" if len(rows) == 1 else ""
    source = f" (for {runs[0].source})" if runs[0].source else ""
    # An orbit has one panel, that of Λ, if the band of ΔJ would fill its own.
    hides_delta_j = any(len(row.panels) == 1 for row in rows)
    quantities = "Λ" if hides_delta_j else "ΔJ = det J − 1 and Λ"
    sentences = [
        _describe_bands(
            max(
                p.last - p.first + 1 for run in drawn_runs for p in figure.merge_buckets(run.series)
            )
        ),
        "ΔJ goes up and down within each band, so that its picture would be a rectangle."
        * hides_delta_j,
        *(
            sentence
            for start_text, group in by_start.items()
            for sentence in _describe_ends(group, start_text if not origin else "")
        ),
        describe_runs(drawn_runs),
    ]
    return captioned_plot(
        lambda: figure.draw_over_time(rows),
        name=name,
        lead=f"{quantities} over time, h = {runs[0].step_size}{origin}{source}",
        caption=" ".join(filter(None, sentences)),
    )


def _describe_bands(steps: int) -> str:
    if steps == 1:
        return "Each level is one step."
    return (
        f"Each band reaches from the least to the greatest value within up to {whole(steps)} steps."
    )


def _describe_ends(runs: Sequence[RunResult], label: str) -> Iterator[str]:
    """Yield a sentence on the last values of the longest run, or on its end."""
    run = max(runs, key=lambda run_of_orbit: run_of_orbit.steps)
    beginning = f"From {label}: the" if label else "The"
    if run.status == "left range":
        steps = whole(run.steps)
        yield f"{beginning} run left the range of {run.arithmetic} before its {steps} steps."
    elif {"delta_j_max", "lambda"} <= set(run.values):
        greatest, final = (
            round_to_few_digits(run.values[key].value) for key in ("delta_j_max", "lambda")
        )
        steps = whole(run.steps)
        yield f"{beginning} greatest |ΔJ| is {greatest}; after {steps} steps Λ is {final}."


SECTION = ReportSection(
    order=50,
    view=_view,
    takes_field=True,
    pictures=lambda view: [Picture((4,), plot) for plot, _ in view],
    terms=lambda _: legend.terms_of_runs(),
    shows="series",
    matching_plots=lambda view, label: ((plot, "") for plot, source in view if source == label),
)
