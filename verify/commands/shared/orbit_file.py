"""The states of a run as CSV, in a file or on standard output."""

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared.destinations import STANDARD_OUTPUT

if TYPE_CHECKING:
    from verify.scenes.results.orbit import OrbitTable
    from verify.scenes.results.run import RunResult


def check_points(points: int | None) -> None:
    """InputError, before the run, for a number of states outside of 1 … 10,000."""
    from verify.arithmetic.exact import whole
    from verify.scenes.results.orbit import MOST_POINTS

    if points is not None:
        whole("points", points, 1, MOST_POINTS)


def write_orbit(result: "RunResult", path: Path, points: int | None) -> None:
    """Writes so many states after the initial one at most; `path`: see `OUT_FILE`.

    InputError where the file cannot be written, and where no digits of the states are known.
    """
    from verify.commands.shared.progress import counting_bar
    from verify.files import write_atomically
    from verify.runs.orbit import orbit_of
    from verify.scenes.results.orbit import MOST_POINTS

    with counting_bar("stepping again, for the states", result.steps) as tell:
        table = orbit_of(result, MOST_POINTS if points is None else points, tell)
    if path == STANDARD_OUTPUT:
        click.echo(as_csv(table), nl=False)
        return
    write_atomically(path, as_csv(table))


def as_csv(table: "OrbitTable") -> str:
    """The rows under a header, ended by line feeds; what is not defined at a state is empty."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(table.rows)
    return file.getvalue()
