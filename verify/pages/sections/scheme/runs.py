"""The runs of one scheme: a table, and sentences on number systems, bounds and fallbacks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from markupsafe import Markup

from verify import observables
from verify.pages.figures.captioned_plot import describe_runs
from verify.pages.sections import table_rows
from verify.pages.sections.section import ReportSection
from verify.pages.text import legend
from verify.pages.text.typography import number, start, value, whole
from verify.scenes.frozen import OfScheme
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult


@dataclass(frozen=True)
class RunTable:
    """The runs of one scheme: a column for each observable, a group for each initial value."""

    columns: tuple[str, ...]
    groups: tuple[table_rows.Group, ...]
    count: int
    excerpt: str  # a sentence on the rows that are shown, if not all are
    provenance: str
    certainty: str  # a sentence on the bounds that are rigorous
    notes: tuple[str, ...]  # on runs in another number system, and on runs that left H's domain
    proved_columns: tuple[str, ...]  # those whose values a proof gives for all runs


def _view(scene: SceneResult, proof: OfScheme, _: str) -> RunTable | None:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    computed = observables.select({name for run in runs for name in run.values})
    columns = {each.name: each.heading or each.label for each in computed}
    names = [*columns]
    if not names and all(run.status == "finished" for run in runs):
        return None
    failed = [run for run in runs if _has_failed(run)]
    (visible,) = table_rows.select_members([runs], _has_failed)
    return RunTable(
        columns=tuple(columns[n] for n in names) or ("outcome",),
        groups=tuple(_groups(visible, names)),
        count=len(runs),
        excerpt=table_rows.describe_excerpt(len(runs), len(visible), len(failed)),
        provenance=describe_runs(runs),
        certainty=_describe_certainty(runs),
        notes=(*_describe_fallbacks(runs), *_describe_exits(runs)),
        proved_columns=tuple(columns[n] for n in names if all(n in run.exact for run in runs)),
    )


def _has_failed(run: RunResult) -> bool:
    return run.status != "finished"


def _describe_certainty(runs: Sequence[RunResult]) -> str:
    """Return a sentence on how many of the runs are certified."""
    finished = [run for run in runs if run.status == "finished"]
    enclosed_count = sum(run.error_kind == "enclosed" for run in finished)
    if not finished:
        return ""
    if enclosed_count == len(finished):
        subject = "The run is" if enclosed_count == 1 else f"All {whole(enclosed_count)} runs are"
        return (
            f"{subject} certified: the error bounds are rigorous (enclosed), so each value is "
            "proved to lie within its bound."
        )
    if enclosed_count == 0:
        return "The error bounds are estimates, not certificates."
    return (
        f"{whole(enclosed_count)} of {whole(len(finished))} runs are certified, with rigorous "
        "(enclosed) error bounds; the bounds of the others are estimates."
    )


def _describe_fallbacks(runs: Sequence[RunResult]) -> Iterator[str]:
    """Yield sentences on runs in another number system than the requested one, with the reasons."""
    fallback_runs = [run for run in runs if run.fallback]
    groups = table_rows.by_key(fallback_runs, lambda run: (run.arithmetic, run.fallback))
    for (arithmetic, reason), group in groups.items():
        sizes = ", ".join(dict.fromkeys(number(run.step_size) for run in group))
        count = "One run" if len(group) == 1 else f"{whole(len(group))} runs"
        yield f"{count} (h = {sizes}) went to {arithmetic} instead: {reason}"


def _describe_exits(runs: Sequence[RunResult]) -> Iterator[str]:
    """Yield sentences on runs that leave the domain of H, although the scheme continues."""
    for run in (run for run in runs if run.left_domain):
        yield f"From {start(run)}, h = {number(run.step_size)}: {run.left_domain}"


def _groups(runs: Sequence[RunResult], names: Sequence[str]) -> Iterator[table_rows.Group]:
    for label, group in table_rows.by_key(runs, start).items():
        yield table_rows.Group(label, [_row(run, names) for run in group])


def _row(run: RunResult, names: Sequence[str]) -> table_rows.TableRow:
    failure = ""
    if run.status == "left range":
        failure = f"left the range of {run.arithmetic}"
        if run.failed_step is not None:
            failure += f" at step {whole(run.failed_step)}"
    elif run.status == "unresolved":
        failure = f"no digit could be confirmed: {run.error_method}"
    cells = (value(run.values[n]) if n in run.values else Markup("–") for n in names)
    return table_rows.TableRow(
        run.step_size, (whole(run.steps), *(() if failure else cells)), failure
    )


SECTION = ReportSection(
    order=80, view=_view, terms=lambda _: legend.terms_of_runs(), takes_field=True
)
