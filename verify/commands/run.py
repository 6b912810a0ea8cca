"""The command `verify run`: N steps, each number with its error bound."""

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify import arithmetic as number_systems
from verify.commands.shared import output as show
from verify.commands.shared.destinations import (
    OUT_FILE,
    OUT_FOLDER,
    STANDARD_OUTPUT,
    ensure_keepable,
)
from verify.commands.shared.execution_options import cache_option, counting_bar
from verify.commands.shared.input import (
    parse_coordinates,
    scheme_option,
    start_options,
    with_kept_hamiltonian,
)
from verify.commands.shared.output import CommandAnswer, answering
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.results.run import OrbitTable, RunResult


@click.command()
@with_kept_hamiltonian
@scheme_option
@answering
@cache_option
@click.option("--step-size", required=True, metavar="H", help="The step size, greater than 0.")
@click.option(
    "--steps", type=int, metavar="N", help="The number of steps, at least 1; or give --time."
)
@click.option("--time", metavar="T", help="N is T/H rounded down.")
@click.option(
    "--t0", default="0", metavar="T0", help="The start time, if the Hamiltonian depends on t."
)
@start_options
@click.option(
    "--digits", type=int, metavar="D", help="The number of significant digits that are requested."
)
@click.option(
    "--arithmetic",
    help=f"{', '.join(number_systems.names())}; or auto, the fastest that certifies the digits. "
    "By default float64, or auto if --digits is given.",
)
@click.option(
    "--csv",
    "table",
    type=OUT_FILE,
    metavar="FILE",
    help="Write t, p, q, H − H₀, ΔJ and Λ of the states to this file; - is standard output, which "
    "then gets nothing else.",
)
@click.option(
    "--points",
    type=int,
    metavar="N",
    help="The largest number of states in the file after the initial one.  [default: 10000]",
)
@click.option(
    "--keep",
    type=OUT_FOLDER,
    metavar="DIR",
    help="Keep checkpoints in this folder; the same command continues from them.",
)
def run(hamiltonian: "Hamiltonian", scheme: str, **options: Any) -> CommandAnswer:
    """Run N steps and report Λ, MSE, max |ΔJ| and the last state, each with its error bound.

    With --keep, an interruption costs at most some seconds of work. The file of --csv begins with
    the initial state, and has every step of a run of up to 10,000; of a longer run it has every
    second, third, … step.

    \b
    verify run --system pendulum --scheme lie2 --step-size 0.01 --time 20 --q 1 --p 0 \\
           --csv orbit.csv
    """
    from verify.arithmetic.exact import whole
    from verify.scenes.results.run import MOST_POINTS

    csv_path, points = options.pop("table"), options.pop("points")
    if csv_path == STANDARD_OUTPUT and click.get_current_context().params["as_json"]:
        raise InputError("--csv", "-", "does not go with --json: both are for standard output")
    if points is not None and csv_path is None:
        raise InputError("--points", points, "goes with --csv")
    if points is not None:
        whole("points", points, 1, MOST_POINTS)
    result, note = _run_scheme(hamiltonian, scheme, **options)
    if csv_path is not None:
        _write_orbit(result, csv_path, MOST_POINTS if points is None else points)

    def show_run() -> None:
        show.print_run(result)
        if note:
            click.echo(note)

    # With `--csv -` standard output gets the table alone, and remarks go to standard error.
    def show_status() -> None:
        for line in filter(None, (show.explain_unfinished(result), note)):
            click.echo(line, err=True)

    return CommandAnswer(
        lambda: show.run_json(result),
        show_status if csv_path == STANDARD_OUTPUT else show_run,
        failed=result.status != "finished",
    )


def _run_scheme(
    hamiltonian: "Hamiltonian",
    scheme: str,
    *,
    steps: int | None,
    time: str | None,
    step_size: str,
    digits: int | None,
    arithmetic: str | None,
    keep: Path | None,
    q: str,
    p: str,
    t0: str,
) -> "tuple[RunResult, str]":
    """Return the run, and a note if --time is no multiple of the step size; else an empty text."""
    from verify.arithmetic.exact import positive
    from verify.execution.keeper import Keeper, name_of
    from verify.hamiltonians.run_domain import check_start
    from verify.runs.requested_run import run as run_scheme
    from verify.scenes.observables import REPORTED, carries
    from verify.scenes.values import AUTO, describe_rounding, steps_from

    start: dict[str, Any] = {
        "q": parse_coordinates(q, hamiltonian),
        "p": parse_coordinates(p, hamiltonian),
        "t0": t0,
    }
    check_start(hamiltonian, **start)
    arithmetic = arithmetic or (AUTO if digits else "float64")
    count = steps_from(steps, time, step_size)
    if keep is not None:
        ensure_keepable(keep)
    # It names the checkpoints: a command with any other argument must not continue from them.
    run_identity = (
        hamiltonian.formula,
        hamiltonian.values,
        scheme,
        step_size,
        count,
        start,
        digits,
        arithmetic,
    )
    keeper, has_all_reported = (
        Keeper(keep, name_of(run_identity)),
        all(carries(hamiltonian, n) for n in REPORTED),
    )
    with counting_bar("stepping", count) as advance:
        result = run_scheme(
            hamiltonian,
            scheme,
            step_size=step_size,
            steps=count,
            arithmetic=arithmetic,
            digits=17 if digits is None else digits,
            # In float64 the plain evaluation of Λ shows the effect of rounding, so it is reported
            # too; at many digits the effect cannot be seen.
            observables=REPORTED if arithmetic == "float64" and has_all_reported else None,
            progress=advance,
            keeper=keeper,
            **start,
        )
    keeper.clear()
    end_time = None if time is None else positive(time, "time")
    return result, describe_rounding(end_time, [positive(step_size, "step_size")])


def _write_orbit(result: "RunResult", path: Path, points: int) -> None:
    """Write the initial state and at most `points` states after it; `path`: see `OUT_FILE`.

    Raises InputError if the file cannot be written, or no digits of the states are known.
    """
    from verify.files import write_atomically
    from verify.runs.orbit_table import orbit_of

    with counting_bar("stepping again, for the states", result.steps) as advance:
        table = orbit_of(result, points, advance)
    if path == STANDARD_OUTPUT:
        click.echo(_format_csv(table), nl=False)
    else:
        write_atomically(path, _format_csv(table))


def _format_csv(table: "OrbitTable") -> str:
    """Return the rows below a header, lines end with a line feed; an undefined value is empty."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(table.rows)
    return file.getvalue()
