"""The command `verify reference compare`: somebody's numbers beside ours."""

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.arithmetic.exact import decimal, rational, short
from verify.commands.shared.execution_options import progress_bar
from verify.commands.shared.input import PATH, SCHEME
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering, pick
from verify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from verify.reference.compare.comparison import (
        Column,
        Explanation,
        TableComparison,
        WorstSeparation,
    )
    from verify.reference.compare.submitted_table import SubmittedTable

_MAX_LINES = 5  # the limit on lines of one kind, each for one run
_MAX_MISTAKES = 4  # the limit on named mistakes if several fit
_SYMBOLS = {"lambda": "Λ", "delta_j": "ΔJ", "mse": "MSE"}
# The verdicts on a column, the mildest first; `Column.verdict` is an index into both tuples.
_VERDICT_KEYS = ("agrees", "lost", "rounding", "perhaps rounding", "more than rounding")
_VERDICT_SENTENCES = (
    "agrees in all digits that are printed",
    "says nothing: rounding may have taken every digit",
    "differs by what float64 rounding explains",
    "differs by more than rounding usually does, and no more than it may do",
    "DIFFERS by more than rounding",
)
# The sentences of verdicts whose columns agree in no digit.
_NO_DIGIT_SENTENCES = {
    "rounding": "differs by what float64 rounding explains, which leaves no digit",
    "perhaps rounding": "may differ by no more than rounding, which leaves no digit",
}
_LONG_NUMBER = re.compile(r"[0-9]+/[0-9]{20,}|[0-9]{25,}(?:/[0-9]+)?")
_MAX_DIGITS = 400  # the limit for the decimal of a long quotient
_MAX_SHOWN_DIGITS = 36  # a longer number is shown without its middle
_LEAST_DIGITS = 0.5  # if fewer digits agree, the text says that none does


@click.command()
@click.argument("theirs", type=PATH, metavar="THEIRS.csv")
@option("--data", "DIR", "The reference data; without it, the committed set.", type=PATH)
@option("--scene", "NAME", "The scene of all rows, such as duffing.")
@option("--scheme", "NAME", "The scheme of all rows.", type=SCHEME)
@option("--step-size", "H", "Their step size.")
@option("--q q0", "X", "Their initial q.")
@option("--p p0", "X", "Their initial p.")
@option("--t0", "T0", "Their start time, if H depends on t.")
@option(
    "--column columns",
    "OURS=THEIRS",
    "The table's name of a column, such as q=position; repeatable.",
    multiple=True,
)
@answering
def compare(
    theirs: Path,
    data: Path | None,
    scene: str | None,
    columns: tuple[str, ...],
    **options: str | None,
) -> CommandAnswer:
    """Compare the numbers in THEIRS.csv, somebody's own, with the reference data.

    THEIRS.csv has a header line, a column step (or time), some of p, q, delta_j, mse and lambda,
    and scene, scheme, step_size, q0 and p0, unless options give them. All rows that the reference
    data have too are compared: how many digits agree, where the numbers part, and whether float64
    rounding explains it. If it does not, known mistakes are tried: the double 0.001 for h = 1/1000,
    p and q swapped, a step index off by one, another scheme or η, … Exit status 1 if a difference
    is larger than rounding.

    verify reference compare mine.csv --scene duffing --scheme lie2

    A table of p1 … pn, q1 … qn, energy, symplectic_defect_max, symplectic_defect and lambda is
    compared with data in n degrees of freedom; its initial values are q0_1 … q0_n and p0_1 … p0_n,
    or --q 0.3,0.1 --p 0,0.2.
    """
    from verify.reference.compare.comparison import compare as compare_tables
    from verify.reference.compare.published_data import load
    from verify.reference.compare.submitted_table import has_degrees, read
    from verify.reference.make.data_folder import PUBLISHED

    labels = {name: x for name, x in {"scene": scene, **options}.items() if x is not None}
    names, folder = _parse_names(columns), data or PUBLISHED
    # The header of their table tells whether to read the data of the plane or of n degrees.
    ours = load(folder, scene, planar=not has_degrees(theirs, names))
    table = read(theirs, ours, labels, names)
    with progress_bar("compared", len(table.runs), unit="run") as advance:
        comparison = compare_tables(ours, table, lambda *_: advance(1))
    return CommandAnswer(
        lambda: _as_json(table, comparison),
        lambda: _print(table, comparison),
        failed=not comparison.agrees,
    )


def _parse_names(columns: tuple[str, ...]) -> dict[str, str]:
    names: dict[str, str] = {}
    for text in columns:
        ours, equals, theirs = text.partition("=")
        if not (ours and equals and theirs):
            raise InputError("--column", text, "write it as OURS=THEIRS, such as q=position")
        if ours in names:
            raise InputError("--column", text, f"{ours} is given twice")
        names[ours] = theirs
    return names


# -- for programs ---------------------------------------------------------------------------------


def _as_json(table: "SubmittedTable", comparison: "TableComparison") -> dict[str, Any]:
    return {
        **pick(comparison, "agrees", "rows", "runs"),
        "rows_read": table.rows,
        **pick(table, "other_steps", "outside"),
        "first_outside": table.first_outside or None,
        "ignored_columns": list(table.ignored),
        "columns": [
            {
                "column": x.name,
                "verdict": _VERDICT_KEYS[x.verdict],
                "rows": x.rows,
                # Infinite if every printed digit agrees; JSON has no infinity.
                "digits": None if math.isinf(x.digits) else f"{x.digits:.1f}",
                **pick(x, "run", "step"),
                "parts_in": x.parts_run,
                "parts_at": x.parts_at,
            }
            for x in comparison.columns
        ],
        "diagnoses": [
            {
                "runs": x.runs,
                "mistakes": [{"id": name, "says": sentence} for name, sentence in x.mistakes],
                "certain": len(x.mistakes) == 1,
            }
            for x in comparison.diagnoses
        ],
        **pick(comparison, "unexplained", "lost", "overflows"),
        "separation": comparison.separated and _separation_json(comparison.separated),
    }


def _separation_json(x: "WorstSeparation") -> dict[str, Any]:

    evaluations = {"plain": x.result.plain, "closed_form": x.result.closed_form}
    parts = {
        name: evaluation.parts.model_dump(mode="json") if evaluation else None
        for name, evaluation in evaluations.items()
    }
    return {"run": x.run, "step": x.step, "difference": decimal(x.apart, 3), **parts}


# -- for people -----------------------------------------------------------------------------------


def _print(table: "SubmittedTable", comparison: "TableComparison") -> None:

    rows, runs = _format_count(comparison.rows, "row"), _format_count(comparison.runs, "run")
    click.echo(f"{rows} of {runs} compared; {_format_count(table.rows, 'row')} read")
    if table.other_steps:
        count = _format_count(table.other_steps, "row")
        click.echo(f"of steps that the reference data do not have: {count}")
    if table.outside:
        first_run = table.first_outside
        count = _format_count(table.outside, "row")
        click.echo(f"of runs that they do not have: {count}, the first {first_run}")
    if table.ignored:
        click.echo(f"columns that mean nothing here: {', '.join(table.ignored)}")
    for name, (theirs, ours) in table.read_as.items():
        click.echo(f"your {name} {short(theirs)} is taken for {short(ours)}")
    for column in comparison.columns:
        click.echo(_describe_column(column))
    if comparison.separated is not None:
        click.echo(_describe_separation(comparison.separated))
    _print_steps(
        comparison.lost, "from step {step} on rounding may have taken every digit; not judged"
    )
    _print_steps(comparison.overflows, "not finite at step {step}, where doubles may overflow")
    for diagnosis in comparison.diagnoses:
        click.echo(_describe_diagnosis(diagnosis))
    unknown = [
        f"{_shorten_label(label)}: no known mistake fits" for label in comparison.unexplained
    ]
    _print_few(unknown, " that none fits")


def _format_count(number: int, noun: str) -> str:
    return f"{number:,} {noun}" + ("" if number == 1 else "s")


def _shorten_label(label: str) -> str:
    """Return a run's label, with its long numbers shortened."""
    return _LONG_NUMBER.sub(lambda match: _shorten_number(match[0]), label)


def _shorten_number(text: str) -> str:
    """Return a long decimal or quotient as a decimal, without the middle of its digits."""

    decimal_text = decimal(rational(text), _MAX_DIGITS)
    # `decimal` writes all digits, then e and a signed exponent.
    digits, _, exponent = decimal_text.partition("e")
    short = digits.rstrip("0").rstrip(".") if "." in digits else digits
    if len(short) > _MAX_SHOWN_DIGITS:
        short = f"{short[: _MAX_SHOWN_DIGITS // 2]}…{short[-_MAX_SHOWN_DIGITS // 2 :]}"
    return f"{short}e{exponent}" if exponent.strip("+0") else short


def _describe_column(x: "Column") -> str:
    name, verdict = _SYMBOLS.get(x.name, x.name), _VERDICT_KEYS[x.verdict]
    if verdict == "lost":
        return f"{name:>3}  {_VERDICT_SENTENCES[x.verdict]}"
    digits_text = (
        "all" if math.isinf(x.digits) else f"{x.digits:.1f}" if x.digits >= _LEAST_DIGITS else "no"
    )
    line = f"{name:>3}  {digits_text:>5} digits  {_VERDICT_SENTENCES[x.verdict]}"
    if x.parts_run is not None:
        return f"{line}, first at step {x.parts_at} ({_shorten_label(x.parts_run)})"
    if digits_text == "no":
        return (
            f"{name:>3}  {_NO_DIGIT_SENTENCES[verdict]} at step {x.step} ({_shorten_label(x.run)})"
        )
    return (
        line
        if verdict == "agrees"
        else f"{line}; the fewest at step {x.step} ({_shorten_label(x.run)})"
    )


def _print_steps(steps: "Mapping[str, int]", template: str) -> None:
    lines = [
        f"{_shorten_label(label)}: {template.format(step=step)}" for label, step in steps.items()
    ]
    _print_few(lines, ", likewise")


def _print_few(lines: "Sequence[str]", ending: str) -> None:
    """Print the first lines, each for one run, and the number of the other runs."""
    for line in lines[:_MAX_LINES]:
        click.echo(line)
    if len(lines) > _MAX_LINES:
        click.echo(f"… and {_format_count(len(lines) - _MAX_LINES, 'more run')}{ending}")


def _describe_separation(x: "WorstSeparation") -> str:

    plain = x.result.plain
    assert plain is not None  # noqa: S101 - without it this is not called
    parts = ", ".join(f"{n} {getattr(plain.parts, n).value}" for n in plain.parts.rounding)
    return (
        f"     your Λ is off by {decimal(x.apart, 2)} at step {x.step} ({_shorten_label(x.run)}); "
        f"rounding makes {plain.parts.total.value} of the Λ of a plain float64 program there "
        f"({parts})"
    )


def _describe_diagnosis(x: "Explanation") -> str:
    many = _format_count(x.runs, "run")
    sentences = [sentences for _, sentences in x.mistakes]
    if len(sentences) == 1:
        return f"in {many}: {sentences[0]}"
    if len(sentences) > _MAX_MISTAKES:
        sentences = [
            *sentences[: _MAX_MISTAKES - 1],
            f"{len(sentences) - _MAX_MISTAKES + 1} others",
        ]
    return f"in {many} one of these, which the table does not tell apart: " + "; or ".join(
        sentences
    )
