"""The runs of one scheme as a table, and in sentences: arithmetic, certainty, fallbacks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from markupsafe import Markup

from verify import observables
from verify.pages.figures.captioned_plot import computed
from verify.pages.sections.by_key import by_key
from verify.pages.sections.rows import Group, Row, shown, told
from verify.pages.sections.section import Section
from verify.pages.text import words
from verify.pages.text.typography import number, start, value, whole
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult


@dataclass(frozen=True)
class RunTable:
    """The runs of one scheme: a column an observable, a group an initial value."""

    columns: tuple[str, ...]
    groups: tuple[Group, ...]
    count: int
    told: str  # which of them are shown, where not all are
    computed: str
    certainty: str  # which of the bounds are rigorous
    notes: tuple[str, ...]  # where another arithmetic was taken, and which left H's domain
    proved: tuple[str, ...]  # the columns that a proof gave, for all runs


def _view(scene: SceneResult, proof: ProofResult, _: str) -> RunTable | None:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    columns = {name: each.heading or each.label for name, each in observables.by_name().items()}
    names = [n for n in columns if any(n in run.values for run in runs)]
    if not names and all(run.status == "finished" for run in runs):
        return None
    failed = [run for run in runs if _failed(run)]
    (held,) = shown([runs], _failed)
    return RunTable(
        columns=tuple(columns[n] for n in names) or ("outcome",),
        groups=tuple(_groups(held, names)),
        count=len(runs),
        told=told(len(runs), len(held), len(failed)),
        computed=computed(runs),
        certainty=_certainty(runs),
        notes=(*_fallbacks(runs), *_beyond(runs)),
        proved=tuple(columns[n] for n in names if all(n in run.exact for run in runs)),
    )


def _failed(run: RunResult) -> bool:
    return run.status != "finished"


def _certainty(runs: Sequence[RunResult]) -> str:
    """How many of the runs are certified, in a sentence."""
    finished = [run for run in runs if run.status == "finished"]
    certain = sum(run.error_kind == "enclosed" for run in finished)
    if not finished:
        return ""
    if certain == len(finished):
        every = "The run is" if certain == 1 else f"All {whole(certain)} runs are"
        return (
            f"{every} certified: the error bounds are rigorous (enclosed), so each value is proved "
            "to lie within its bound."
        )
    if certain == 0:
        return "The error bounds are estimates, not certificates."
    return (
        f"{whole(certain)} of {whole(len(finished))} runs are certified, with rigorous (enclosed) "
        "error bounds; the bounds of the others are estimates."
    )


def _fallbacks(runs: Sequence[RunResult]) -> Iterator[str]:
    """Each reason for another arithmetic than the one asked for, with its runs."""
    elsewhere = [run for run in runs if run.fallback]
    groups = by_key(elsewhere, lambda run: (run.arithmetic, run.fallback))
    for (arithmetic, reason), held in groups.items():
        sizes = ", ".join(dict.fromkeys(number(run.step_size) for run in held))
        count = "One run" if len(held) == 1 else f"{whole(len(held))} runs"
        yield f"{count} (h = {sizes}) went to {arithmetic} instead: {reason}"


def _beyond(runs: Sequence[RunResult]) -> Iterator[str]:
    """Which of them are seen to leave where H is defined, though the scheme goes on."""
    for run in (run for run in runs if run.left_domain):
        yield f"From {start(run)}, h = {number(run.step_size)}: {run.left_domain}"


def _groups(runs: Sequence[RunResult], names: Sequence[str]) -> Iterator[Group]:
    for label, own in by_key(runs, start).items():
        yield Group(label, [_row(run, names) for run in own])


def _row(run: RunResult, names: Sequence[str]) -> Row:
    failure = ""
    if run.status == "left range":
        failure = f"left the range of {run.arithmetic}"
        if run.failed_step is not None:
            failure += f" at step {whole(run.failed_step)}"
    elif run.status == "unresolved":
        failure = f"no digit could be confirmed: {run.error_method}"
    cells = (value(run.values[n]) if n in run.values else Markup("–") for n in names)
    return Row(run.step_size, (whole(run.steps), *(() if failure else cells)), failure)


SECTION = Section(order=80, view=_view, terms=lambda _: words.RAN)
