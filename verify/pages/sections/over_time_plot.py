"""The picture of runs over time, with its caption.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterator, Sequence

from verify.pages.figures.captioned_plot import Plot, computed, few, plotted
from verify.pages.sections.by_key import by_key
from verify.pages.text.typography import start, whole
from verify.scenes.results.run import RunResult


def over_time(runs: Sequence[RunResult], *, name: str) -> Plot:
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
