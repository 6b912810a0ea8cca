"""The states of a run as CSV, in a file or on standard output."""

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.results.orbit import OrbitTable
    from verify.scenes.results.run import RunResult


def write_orbit(result: "RunResult", path: str, points: int | None) -> None:
    """Writes so many states after the initial one at most; "-" is standard output.

    InputError where the file cannot be written, for points outside of 1 … 10,000, and where no
    digits of the states are known.
    """
    from verify.commands.shared.progress import counting_bar
    from verify.files import write_atomically
    from verify.runs.orbit import orbit_of
    from verify.scenes.results.orbit import MOST_POINTS

    with counting_bar("stepping again, for the states", result.steps) as tell:
        table = orbit_of(result, MOST_POINTS if points is None else points, tell)
    if path == "-":
        click.echo(as_csv(table), nl=False)
        return
    try:
        write_atomically(Path(path), as_csv(table))
    except OSError as error:
        problem = error.strerror or "cannot be written"
        raise InputError("--csv", path, problem) from None


def as_csv(table: "OrbitTable") -> str:
    """The rows under a header, ended by line feeds; what is not defined at a state is empty."""
    from verify.scenes.results.orbit import COLUMNS

    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(table.rows)
    return file.getvalue()
