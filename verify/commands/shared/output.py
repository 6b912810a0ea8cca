"""The answer of a command: JSON objects with decimal strings, or short texts for people.

An answer sets the exit status too.
"""

import json
import sys
import textwrap
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify import observables
from verify.commands.shared.option import flag
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.frozen import Frozen
    from verify.scenes.measured_structures import MeasuredStructure
    from verify.scenes.results.report import Report
    from verify.scenes.results.run import RunResult
FAILED = 1  # the exit status if a check failed


@dataclass(frozen=True)
class CommandAnswer:
    """An answer: `data` returns it as JSON, `show` prints it for people; only one is called.

    `failed`: a check failed. `timed`: JSON ends with the seconds that the command took. `problem`:
    another error, which is raised after the output.
    """

    data: Callable[[], dict[str, Any]]
    show: Callable[[], None]
    failed: bool = False
    timed: bool = False
    problem: InputError | None = None


def answering(command: Callable[..., CommandAnswer]) -> Callable[..., None]:
    """Add --json to a command, print its answer, and exit with the answer's status."""

    @wraps(command)
    def wrapper(*args: Any, as_json: bool, **options: Any) -> None:
        start_time = time.perf_counter()
        answer = command(*args, **options)
        seconds = f"{time.perf_counter() - start_time:.6f}"
        if as_json:
            data = answer.data() | ({"seconds": seconds} if answer.timed else {})
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            # If the stream has another encoding, escapes are written, which JSON reads alike.
            ascii_only = encoding.lower().replace("-", "") != "utf8"
            click.echo(json.dumps(data, ensure_ascii=ascii_only))
        else:
            answer.show()
        if answer.problem is not None:
            raise answer.problem
        if answer.failed:
            raise SystemExit(FAILED)

    return flag("--json as_json", "One JSON object on standard output.")(wrapper)


def pick(source: object, *names: str) -> dict[str, Any]:
    """Return the attributes of `source` with these names, by the same names."""
    return {name: getattr(source, name) for name in names}


# -- as JSON and as text ---------------------------------------------------------------------------

_LINE_WIDTH, _NAME_WIDTH = 88, 10  # characters; a line begins with a name
_MAX_CHARACTERS = 400  # the limit for a formula on a terminal


def cut(formula: str) -> str:
    """Return the formula, or its beginning if it is long: the JSON has all of it."""
    if len(formula) <= _MAX_CHARACTERS:
        return formula
    terms = formula.count(" + ") + formula.count(" - ") + 1
    # The last term may be cut: it goes, with the sign before it.
    return f"{formula[:_MAX_CHARACTERS].rsplit(' ', 2)[0]} … ({terms} terms; --json has them)"


def print_line(name: str, text: str) -> None:
    """Print a name and its text, wrapped."""
    beginning, indent = f"  {name:{_NAME_WIDTH}} ", " " * (_NAME_WIDTH + 3)
    click.echo(textwrap.fill(text, _LINE_WIDTH, initial_indent=beginning, subsequent_indent=indent))


def run_json(result: "RunResult", measured: "Sequence[MeasuredStructure]") -> dict[str, Any]:
    """Return the keys of a run, with `keeps` if it measures what a step keeps."""
    from verify.scenes.observables import REPORTED, names

    # Each usual observable has a key, null if it was not computed, so that programs can rely on it;
    # another observable has a key only if it was computed.
    by_name, planar = observables.by_name(), isinstance(result.q, str)
    keys = dict.fromkeys((*names(planar=planar), *REPORTED))
    usual = (
        n
        for n in keys
        if (by_name[n].usual or by_name[n].aside or n in REPORTED)
        and (by_name[n].of_any_field or not result.start)
    )
    selected = dict.fromkeys((*usual, *(n for n in keys if n in result.values)))
    places = ("state",) if result.start else ("q", "p")
    values = {name: _value_json(result, name) for name in (*selected, *places)}
    return {
        **{name: value for name, (value, _) in values.items()},
        **pick(result, "steps", "digits", "arithmetic", "fallback", "left_domain"),
        "error_bound": {name: bound for name, (_, bound) in values.items() if bound},
        # `exact` names the values that come from a proof, not from the run.
        **pick(result, "error_kind", "error_method", "exact", "status", "failed_step"),
        "seconds": f"{result.seconds:.6f}",
        **({"keeps": [_measured_json(result, each) for each in measured]} if measured else {}),
    }


def _measured_json(result: "RunResult", measured: "MeasuredStructure") -> dict[str, Any]:
    values = measured.select(result.values)
    return {
        **pick(measured, "structure", "label", "defect"),
        **{name: x and x.value for name, x in values.items()},
        "error_bound": {name: x.bound for name, x in values.items() if x},
        "exact": measured.at_end in result.exact,
    }


def _value_json(result: "RunResult", name: str) -> tuple[Any, Any]:
    """Return a value and its bound; for q or p in n degrees of freedom a list of each, and for the
    state of equations each by name."""
    if name == "state":
        state = {n: result.values[n] for n in result.start if n in result.values}
        texts, bounds = ({n: getattr(x, k) for n, x in state.items()} for k in ("value", "bound"))
        return (texts, bounds) if state else (None, None)
    if name in ("q", "p") and not isinstance(result.q, str):
        coordinates = [x for n, x in result.values.items() if n[0] == name and n[1:].isdigit()]
        return (
            ([x.value for x in coordinates], [x.bound for x in coordinates])
            if coordinates
            else (None, None)
        )
    value = result.values.get(name)
    return (value.value, value.bound) if value else (None, None)


def explain_unfinished(result: "RunResult") -> str:
    """Return the reason why a run has no numbers; an empty text if it has."""
    if result.status == "finished":
        return ""
    if result.status == "unresolved":
        return f"no digit is known: {result.error_method}"
    return (
        f"at step {result.failed_step} the orbit leaves the domain of H or the range of "
        f"{result.arithmetic} (other than float64 stops beyond 2^4000)"
    )


def print_once(notes: Iterable[str]) -> None:
    """Print each note that is not empty on a line, and equal notes only once."""
    for note in filter(None, dict.fromkeys(notes)):
        click.echo(note)


def print_run(result: "RunResult", measured: "Sequence[MeasuredStructure]" = ()) -> None:
    """Print the values of a run, and below them what else it measures of what a step keeps."""
    if result.status != "finished":
        click.echo(explain_unfinished(result))
        return
    labels = {
        name: observable.short or observable.label
        for name, observable in observables.by_name().items()
    }
    coordinates = {n: n for n in result.values if n[1:].isdigit() or n in result.start}
    for name, label in {**labels, "q": "q", "p": "p", **coordinates}.items():
        if name in result.values:
            value = result.values[name]
            text = str(value) if value.unknown else f"{value.value}  ± {value.bound}"
            click.echo(f"{label:10} {text}")
    for structure in measured:
        # The others are among the labels above.
        if structure.at_end not in labels:
            click.echo(structure.label)
            for name, x in structure.select(result.values).items():
                if x:
                    click.echo(f"  {name.replace('_', ' '):10} {x}")
    click.echo(
        f"{result.steps} steps in {result.arithmetic}, {result.seconds:.3g} s; bounds "
        f"{result.error_kind} ({result.error_method})"
    )
    if result.fallback:
        click.echo(f"taken instead of what was asked for: {result.fallback}")
    if result.left_domain:
        click.echo(result.left_domain)


def plain_json(model: "Frozen") -> dict[str, Any]:
    """Return the model as JSON, with each prose as a plain text."""
    from verify.scenes.frozen import PLAIN

    data: dict[str, Any] = model.model_dump(mode="json", context=PLAIN)
    return data


def print_report(report: "Report", *pages: Path) -> None:
    from verify.scenes.results.claim import describe_counts

    for line in report.preface:
        click.echo(line)
    for claim in report.claims:
        click.echo(f"{claim.verdict:9}  {claim.source}: {claim.evidence}")
    if report.statements:
        click.echo(describe_counts(report.statements, report.claims))
    for scene in report.scenes:
        for kept in scene.keeps:
            for structure in kept.keeps:
                line = f"{scene.name}, {kept.scheme_title}: {structure.label}: {structure.reason}"
                click.echo(f"{structure.verdict:9}  {line}")
        for result in scene.criteria:
            click.echo(
                f"{result.verdict:9}  {scene.name}, {result.scheme}, criterion {result.number}"
            )
    click.echo(f"{', '.join(map(str, pages))} ({report.provenance.seconds:.3g} s)")
