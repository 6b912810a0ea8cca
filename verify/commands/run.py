"""The command `verify run`: N steps, each number with its error bound."""

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify import arithmetic as number_systems
from verify.arithmetic.exact import positive, whole
from verify.commands.shared import destinations
from verify.commands.shared import output as show
from verify.commands.shared.execution_options import cache_option, counting_bar
from verify.commands.shared.input import (
    parse_coordinates,
    scheme_option,
    values_of,
    with_kept_system,
)
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering
from verify.commands.shared.structure_options import compose_scheme, split_option, structure_options
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.measured_structures import MeasuredStructure
    from verify.scenes.results.run import OrbitTable, RunResult
    from verify.structures.reading import KeepsRequest


@click.command()
@with_kept_system
@scheme_option
@answering
@cache_option
@structure_options
@split_option
@option("--step-size", "H", "The step size, greater than 0.", required=True)
@option("--steps", "N", "The number of steps, at least 1; or give --time.", type=int)
@option("--time", "T", "N is T/H rounded down.")
@option("--t0", "T0", "The start time, if the Hamiltonian depends on t.", default="0")
@option("--q", "Q", "Initial displacement; of q1, q2, … one each, as 0.1,0.2.")
@option("--p", "P", "Initial momentum; as --q.")
@option("--start", "NAME=VALUE,…", "Of --field: the initial values, as u=1,v=2.")
@option("--digits", "D", "The number of significant digits that are requested.", type=int)
@click.option(
    "--arithmetic",
    help=f"{', '.join(number_systems.names())}; or auto, the fastest that certifies the digits. "
    "By default float64, or auto if --digits is given.",
)
@option(
    "--csv table",
    "FILE",
    "Write t, p, q, H − H₀, ΔJ and Λ of the states to this file; - is standard output, which "
    "then gets nothing else.",
    type=destinations.OUT_FILE,
)
@option(
    "--points",
    "N",
    "The largest number of states in the file after the initial one.  [default: 10000]",
    type=int,
)
@option(
    "--keep",
    "DIR",
    "Keep checkpoints in this folder; the same command continues from them.",
    type=destinations.OUT_FOLDER,
)
def run(
    hamiltonian: "Hamiltonian",
    scheme: str,
    keeps: "KeepsRequest",
    splits: tuple[str, ...],
    **options: Any,
) -> CommandAnswer:
    """Run N steps and report Λ, MSE, max |ΔJ|, H − H₀ and the last state, each with its bound.

    With --keeps, what the step keeps is measured too, and not judged: the change of a first
    integral, the accumulated defect of a form, of volume or of a bracket, the way back.

    With --keep, an interruption costs at most some seconds of work. The file of --csv begins with
    the initial state, and has every step of a run of up to 10,000; of a longer run it has every
    second, third, … step.

    \b
    verify run --system pendulum --scheme lie2 --step-size 0.01 --time 20 --q 1 --p 0 \\
           --csv orbit.csv
    """
    from verify.scenes.measured_structures import measured_structures
    from verify.scenes.results.run import MOST_POINTS

    csv_path, points = options.pop("table"), options.pop("points")
    if csv_path == destinations.STANDARD_OUTPUT and click.get_current_context().params["as_json"]:
        raise InputError("--csv", "-", "does not go with --json: both are for standard output")
    if points is not None and csv_path is None:
        raise InputError("--points", points, "goes with --csv")
    if points is not None:
        whole("points", points, 1, MOST_POINTS)
    measured = measured_structures(hamiltonian, keeps) if keeps else ()
    scheme = compose_scheme(scheme, splits, hamiltonian)
    result, note = _run_scheme(hamiltonian, scheme, measured, **options)
    if csv_path is not None:
        _write_orbit(result, csv_path, MOST_POINTS if points is None else points)

    def show_run() -> None:
        show.print_run(result, measured)
        if note:
            click.echo(note)

    # With `--csv -` standard output gets the table alone, and remarks go to standard error.
    def show_status() -> None:
        for line in filter(None, (show.explain_unfinished(result), note)):
            click.echo(line, err=True)

    return CommandAnswer(
        lambda: show.run_json(result, measured),
        show_status if csv_path == destinations.STANDARD_OUTPUT else show_run,
        failed=result.status != "finished",
    )


def _run_scheme(
    hamiltonian: "Hamiltonian",
    scheme: str,
    measured: "tuple[MeasuredStructure, ...]",
    *,
    steps: int | None,
    time: str | None,
    step_size: str,
    digits: int | None,
    arithmetic: str | None,
    keep: Path | None,
    q: str | None,
    p: str | None,
    start: str | None,
    t0: str,
) -> "tuple[RunResult, str]":
    """Return the run, and a note if --time is no multiple of the step size; else an empty text."""
    from verify.execution.keeper import Keeper, name_of
    from verify.hamiltonians.run_domain import check_point, start_of
    from verify.runs.requested_run import run as run_scheme
    from verify.scenes.observables import REPORTED, carries, observables_aside, select_observables
    from verify.scenes.values import AUTO, describe_rounding, steps_from

    pairs = None if start is None else tuple(part.strip() for part in start.split(","))
    for name, value in (("q", q), ("p", p)):
        if value is None and hamiltonian.has_energy:
            raise InputError(f"--{name}", NOT_GIVEN, f"is missing; write --{name} {name.upper()}")
    begin: dict[str, Any] = {
        "q": q and parse_coordinates(q, hamiltonian),
        "p": p and parse_coordinates(p, hamiltonian),
        "start": pairs and values_of(pairs, "--start"),
    }
    check_point(hamiltonian, start_of(hamiltonian, **begin), t0)
    begin["t0"] = t0
    arithmetic = arithmetic or (AUTO if digits else "float64")
    count = steps_from(steps, time, step_size)
    if keep is not None:
        destinations.ensure_keepable(keep)
    # It names the checkpoints: a command with any other argument must not continue from them.
    run_identity = (
        hamiltonian.formula,
        hamiltonian.values,
        scheme,
        step_size,
        count,
        begin,
        digits,
        arithmetic,
        measured,
    )
    keeper = Keeper(keep, name_of(run_identity))
    has_all_reported = all(carries(hamiltonian, n) for n in REPORTED)
    # In float64 the plain evaluation of Λ shows the effect of rounding, so it is reported too; at
    # many digits the effect cannot be seen.
    is_plain = arithmetic == "float64" and has_all_reported
    names = REPORTED if is_plain else select_observables(hamiltonian, None)
    names += tuple(name for structure in measured for name in structure.observables)
    with counting_bar("stepping", count) as advance:
        result = run_scheme(
            hamiltonian,
            scheme,
            step_size=step_size,
            steps=count,
            arithmetic=arithmetic,
            digits=17 if digits is None else digits,
            observables=tuple(dict.fromkeys(names)),
            aside=observables_aside(hamiltonian),
            progress=advance,
            keeper=keeper,
            **begin,
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
    if path == destinations.STANDARD_OUTPUT:
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
