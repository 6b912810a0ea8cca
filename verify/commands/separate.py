"""The command `verify separate`: truncation and rounding in Λ of a float64 run, or in W.

Λ = Π det J − 1, over all steps, is the cumulative area error. In n degrees of freedom each entry of
W = MᵀΩM − Ω is split in its stead, M the product of the Jacobians of all steps.

The parts are truncation, which exact arithmetic has too, and four kinds of rounding: input,
trajectory, determinant (in n degrees of freedom: derivatives) and product. If H depends on time,
clock is a fifth kind. `verify.studies.separation.truncation_and_rounding` defines them.

Λ or W is evaluated in two ways: plain, as most programs do, and in closed form, where nothing
cancels. Each has its own rounding, and its own crossover: the step size below which rounding is
larger than truncation.
"""

import textwrap
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.execution_options import cache_option, progress_bar
from verify.commands.shared.input import (
    parse_coordinates,
    scheme_option,
    start_options,
    with_kept_hamiltonian,
)
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering, pick, plain_json, print_once
from verify.commands.shared.separated_integrals import (
    change_json,
    integrals_of,
    print_change,
    split_changes,
)
from verify.commands.shared.structure_options import structure_options

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.results.separation import AnyGrid, CrossoverResult, Separation
    from verify.scenes.results.separation_parts import AnyEvaluation, PartsOfRun
    from verify.structures.reading import KeepsRequest

_LINE_WIDTH = 88  # characters, of prose
_EVALUATION_LABELS = {"plain": "plain", "closed_form": "closed form"}


def grid_json(grid: "AnyGrid") -> dict[str, Any]:
    """Return the separation at the first step size, and under `grid` those at all step sizes.

    Each part is a number if Λ is split, and a matrix if W is.
    """
    separations = [_separation_json(separation) for separation in grid.points]
    crossovers = {key: getattr(grid, key).model_dump(mode="json") for key in _EVALUATION_LABELS}
    seconds = f"{sum(separation.seconds for separation in grid.points):.6f}"
    return {**separations[0], "crossover": crossovers, "grid": separations, "seconds": seconds}


def _separation_json(separation: "Separation") -> dict[str, Any]:
    # The result of a separation of W alone has these two.
    form_keys = {k: x for k, x in plain_json(separation).items() if k in ("coordinates", "tangent")}
    return {
        **form_keys,
        **_evaluation_json(separation.plain, separation.split_into),
        "closed_form": _evaluation_json(separation.closed_form, separation.split_into),
        **pick(separation, "step_size", "steps", "digits"),
        "working_arithmetic": "float64",
        **pick(separation, "arithmetic", "error_method", "status", "failed_step", "reason"),
        "seconds": f"{separation.seconds:.6f}",
    }


def _evaluation_json(
    evaluation: "AnyEvaluation | None", default_model: "type[PartsOfRun]"
) -> dict[str, Any]:
    """Return the parts of an evaluation; without one, the fields of `default_model`, all null."""
    names = list((type(evaluation.parts) if evaluation else default_model).model_fields)
    working_name = names[0]  # the first field of such a model is float64's value, the sum of parts
    values = {n: getattr(evaluation.parts, n) for n in names} if evaluation else {}
    texts = {n: values[n].value if evaluation else None for n in names}
    law = getattr(evaluation, "law", None)  # that of the entries of W; Λ has none
    return {
        working_name: texts.pop(working_name),
        "truncation": texts.pop("truncation"),
        "rounding": texts,
        "error_bound": {n: value.bound for n, value in values.items()},
        "error_kind": evaluation.error_kind if evaluation else None,
        "largest": evaluation.largest if evaluation else None,
        "growth": {n: plain_json(x) for n, x in evaluation.growth.items()} if evaluation else None,
        **({"law": law and plain_json(law)} if working_name == "w_working" else {}),
        "series": [x.model_dump(mode="json") for x in evaluation.series] if evaluation else [],
    }


def print_grid(grid: "AnyGrid") -> None:
    """Print the parts at each step size, and for several the step size of each crossover."""
    for separation in grid.points:
        click.echo(f"h = {separation.step_size}, {separation.steps} steps")
        if separation.status != "finished":
            step_note = f" at step {separation.failed_step}" if separation.failed_step else ""
            click.echo(f"  {separation.status}{step_note}: {separation.reason}")
        else:
            _print_parts(separation)
    if len(grid.points) > 1:
        for key, label in _EVALUATION_LABELS.items():
            crossover_text = _describe_crossover(getattr(grid, key))
            click.echo(f"rounding overtakes truncation, {label}: {crossover_text}")


def _print_parts(separation: "Separation") -> None:
    evaluations = {_EVALUATION_LABELS[key]: x for key, x in separation.ways.items()}
    parts, kinds = evaluations["plain"].parts, [x.error_kind for x in evaluations.values()]
    # For Λ the line at the foot has the kind of the plain evaluation's bounds alone.
    head, width, bound_kinds = (
        ("greatest entry", 38, kinds) if separation.greatest else ("", 26, kinds[:1])
    )
    click.echo(f"  {head:16}{'plain':{width}}{'closed form' if len(evaluations) > 1 else ''}")
    # The labels of the kinds of rounding are indented by two blanks.
    for name, label in parts.labels("  ").items():
        cells = (_format_cell(separation, getattr(x.parts, name)) for x in evaluations.values())
        click.echo(f"  {label:16}" + "".join(f"{cell:{width}}" for cell in cells).rstrip())
    for label, evaluation in evaluations.items():
        click.echo(f"  {_describe_growth(evaluation, label)}")
    if len(evaluations) < 2:
        click.echo("  no closed form: some det J ≤ 0, which has no logarithm")
    if tangent := getattr(separation, "tangent", None):
        click.echo(
            f"  tangent map: ‖M‖² = {float(tangent.norm_squared):.3g}, "
            f"‖∧²M‖ = {float(tangent.areas):.3g}, finite-time Lyapunov exponent "
            f"{tangent.finite_time_lyapunov} over T = {tangent.time}"
        )
        meaning = textwrap.fill(str(tangent.meaning), _LINE_WIDTH, subsequent_indent="  ")
        click.echo(f"  {meaning}")
    click.echo(
        f"  {separation.arithmetic} as exact arithmetic, {separation.seconds:.3g} s; "
        f"bounds {', '.join(dict.fromkeys(bound_kinds))} ({separation.error_method})"
    )


def _format_cell(separation: Any, value: Any) -> str:
    """Return a number as text, and a matrix as its greatest entry in absolute value, with its name.

    If that entry is 0 to all known digits, it has no name.
    """
    if not hasattr(value, "largest"):
        return str(value.value)
    entry_name = separation.name_of(value.place) if value.largest.exact else ""
    return f"{value.largest.value:24} {entry_name}"


def _describe_growth(evaluation: "AnyEvaluation", label: str) -> str:
    """Describe how rounding in Λ grows with N; in n degrees of freedom, how max |W| does."""
    law, growth = getattr(evaluation, "law", None), evaluation.growth["total"]
    if law is None:
        return f"rounding with N, {label}: {growth.name} ({growth.reason})"
    return f"max |W| with N, {label}: {law.name} ({law.reason}; measured, not proved)"


def _describe_crossover(crossover: "CrossoverResult") -> str:
    if crossover.bracket is None:
        return crossover.reason
    lower, upper = crossover.bracket
    return f"h* = {crossover.step_size or '?'}, {lower} … {upper} ({crossover.reason})"


@click.command()
@with_kept_hamiltonian
@scheme_option
@answering
@cache_option
@option(
    "--step-size step_sizes",
    "H",
    "The step size, greater than 0; repeatable, for a grid of step sizes.",
    required=True,
    multiple=True,
)
@option("--steps", "N", "The number of steps, at least 1; or give --time.", type=int)
@option("--time", "T", "For each step size H, N is T/H rounded down.")
@option("--t0", "T0", "The start time, if the Hamiltonian depends on t.", default="0")
@start_options
@structure_options
@option("--digits", "D", "Significant digits of every part.", type=int, default=17)
@click.option(
    "--arithmetic",
    default="auto",
    help="The number system that stands for exact arithmetic, as for `verify run`; not float64.",
)
def separate(
    hamiltonian: "Hamiltonian",
    scheme: str,
    step_sizes: tuple[str, ...],
    keeps: "KeepsRequest",
    **options: Any,
) -> CommandAnswer:
    """Split Λ of a float64 run into truncation and four kinds of rounding, which add up exactly.

    Λ = Π det J − 1 over all steps is the area error of the run, and truncation is what exact
    arithmetic would make of it. Rounding is split by its place: input (the step size, parameters
    and initial value), trajectory (the states), determinant (each det J), product. If the
    Hamiltonian depends on t, float64's clock, t + h + h + …, adds a fifth kind.

    For coordinates p1 … pn and q1 … qn, each entry of W = MᵀΩM − Ω is split, where M is the product
    of the Jacobians of all steps; derivatives, the entries of these Jacobians, take the place of
    determinant.

    With several step sizes, the one below which rounding is larger than truncation is given too.

    With --keeps, the change of a first integral is split too: rounding of the inputs, of the
    trajectory, and of the evaluation of the integral at its ends.
    """
    from verify.arithmetic.exact import positive
    from verify.hamiltonians.run_domain import check_start
    from verify.scenes.values import describe_rounding
    from verify.studies.separation.truncation_and_rounding import RUNS, count_steps, separate_grid

    # q and p are checked before the runs, which may be long.
    options |= {name: parse_coordinates(options[name], hamiltonian) for name in ("q", "p")}
    check_start(hamiltonian, options["q"], options["p"], options["t0"])
    step_counts = count_steps(step_sizes, options["steps"], options["time"])  # pairs of h and N
    integrals = integrals_of(hamiltonian, keeps)
    with progress_bar("stepping", RUNS * sum(n for _, n in step_counts)) as advance:
        options |= {"step_sizes": step_sizes, "progress": advance}
        grid = separate_grid(hamiltonian, scheme, **options)
    changes = split_changes(hamiltonian, scheme, integrals, step_counts, options)
    time = options["time"]
    note = describe_rounding(time and positive(time, "time"), [h for h, _ in step_counts])

    def show() -> None:
        print_grid(grid)
        for structure, parts in changes:
            print_change(structure, parts)
        print_once([note])

    def data() -> dict[str, Any]:
        keeps_json = [change_json(*change) for change in changes]
        return {**grid_json(grid), **({"keeps": keeps_json} if changes else {})}

    return CommandAnswer(data, show)
