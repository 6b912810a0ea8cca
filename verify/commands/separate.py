"""The command `verify separate`: truncation and four kinds of rounding in Λ.

In n degrees of freedom they are parts of W.
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
from verify.commands.shared.output import CommandAnswer, answering, pick, plain_json, print_once

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.results.separation import AnyGrid, CrossoverResult, Separation
    from verify.scenes.results.separation_parts import AnyEvaluation, PartsOfRun

_WIDTH = 88  # of a line of prose
_LABELS = {"plain": "plain", "closed_form": "closed form"}


def separation_json(grid: "AnyGrid") -> dict[str, Any]:
    """Return the first step size's parts, and those of all as `grid`; of W each is a matrix."""
    points = [_point_json(point) for point in grid.points]
    crossover = {way: getattr(grid, way).model_dump(mode="json") for way in _LABELS}
    seconds = f"{sum(point.seconds for point in grid.points):.6f}"
    return {**points[0], "crossover": crossover, "grid": points, "seconds": seconds}


def _point_json(point: "Separation") -> dict[str, Any]:
    form = {n: x for n, x in plain_json(point).items() if n in ("coordinates", "tangent")}
    return {
        **form,
        **_way_json(point.plain, point.split_into),
        "closed_form": _way_json(point.closed_form, point.split_into),
        **pick(point, "step_size", "steps", "digits"),
        "working_arithmetic": "float64",
        **pick(point, "arithmetic", "error_method", "status", "failed_step", "reason"),
        "seconds": f"{point.seconds:.6f}",
    }


def _way_json(way: "AnyEvaluation | None", without: "type[PartsOfRun]") -> dict[str, Any]:
    """Return the parts of one evaluation; without one, those of the model `without`, all null."""
    working, *names = (type(way.parts) if way else without).model_fields
    values = {n: getattr(way.parts, n) for n in (working, *names)} if way else {}
    texts = {n: values[n].value if way else None for n in (working, *names)}
    law = getattr(way, "law", None)  # of W alone
    return {
        working: texts.pop(working),
        "truncation": texts.pop("truncation"),
        "rounding": texts,
        "error_bound": {n: value.bound for n, value in values.items()},
        "error_kind": way.error_kind if way else None,
        "largest": way.largest if way else None,
        "growth": {n: plain_json(g) for n, g in way.growth.items()} if way else None,
        **({"law": law and plain_json(law)} if working == "w_working" else {}),
        "series": [point.model_dump(mode="json") for point in way.series] if way else [],
    }


def print_separation(grid: "AnyGrid") -> None:
    """Print the parts at each step size, and where rounding overtakes truncation."""
    for point in grid.points:
        click.echo(f"h = {point.step_size}, {point.steps} steps")
        if point.status != "finished":
            step_note = f" at step {point.failed_step}" if point.failed_step else ""
            click.echo(f"  {point.status}{step_note}: {point.reason}")
        else:
            _print_parts(point)
    if len(grid.points) > 1:
        for way, label in _LABELS.items():
            click.echo(
                f"rounding overtakes truncation, {label}: {_describe_crossover(getattr(grid, way))}"
            )


def _print_parts(point: "Separation") -> None:
    ways = {_LABELS[key]: way for key, way in point.ways.items()}
    parts, kinds = ways["plain"].parts, [way.error_kind for way in ways.values()]
    head, width, reported_kinds = (
        ("greatest entry", 38, kinds) if point.greatest else ("", 26, kinds[:1])
    )
    click.echo(f"  {head:16}{'plain':{width}}{'closed form' if len(ways) > 1 else ''}")
    for name, label in parts.labels("  ").items():
        cells = (_format_cell(point, getattr(way.parts, name)) for way in ways.values())
        click.echo(f"  {label:16}" + "".join(f"{cell:{width}}" for cell in cells).rstrip())
    for label, way in ways.items():
        click.echo(f"  {_describe_growth(way, label)}")
    if len(ways) < 2:
        click.echo("  no closed form: some det J ≤ 0, which has no logarithm")
    if tangent := getattr(point, "tangent", None):
        click.echo(
            f"  tangent map: ‖M‖² = {float(tangent.norm_squared):.3g}, "
            f"‖∧²M‖ = {float(tangent.areas):.3g}, finite-time Lyapunov exponent "
            f"{tangent.finite_time_lyapunov} over T = {tangent.time}"
        )
        meaning = textwrap.fill(str(tangent.meaning), _WIDTH, subsequent_indent="  ")
        click.echo(f"  {meaning}")
    click.echo(
        f"  {point.arithmetic} as exact arithmetic, {point.seconds:.3g} s; "
        f"bounds {', '.join(dict.fromkeys(reported_kinds))} ({point.error_method})"
    )


def _format_cell(point: Any, value: Any) -> str:
    """Return a number as text; of a matrix the greatest entry and its name."""
    if not hasattr(value, "largest"):
        return str(value.value)
    entry_name = point.name_of(value.place) if value.largest.exact else ""
    return f"{value.largest.value:24} {entry_name}"


def _describe_growth(way: "AnyEvaluation", label: str) -> str:
    """Return a line on the growth of rounding with N; in n degrees of freedom, on that of W."""
    law, growth = getattr(way, "law", None), way.growth["total"]
    if law is None:
        return f"rounding with N, {label}: {growth.name} ({growth.reason})"
    return f"max |W| with N, {label}: {law.name} ({law.reason}; measured, not proved)"


def _describe_crossover(way: "CrossoverResult") -> str:
    if way.bracket is None:
        return way.reason
    return f"h* = {way.step_size or '?'}, {way.bracket[0]} … {way.bracket[1]} ({way.reason})"


@click.command()
@with_kept_hamiltonian
@scheme_option
@answering
@cache_option
@click.option(
    "--step-size",
    "step_sizes",
    required=True,
    multiple=True,
    metavar="H",
    help="Greater than 0; repeatable, for a grid of them.",
)
@click.option("--steps", type=int, metavar="N", help="At least 1; or:")
@click.option("--time", metavar="T", help="N is T/H rounded down, for each H.")
@click.option("--t0", default="0", metavar="T", help="When it starts, of an H(p, q, t).")
@start_options
@click.option("--digits", type=int, default=17, metavar="D", help="Digits wanted of every part.")
@click.option(
    "--arithmetic", default="auto", help="What stands for exact: auto, or a number system of run."
)
def separate(
    hamiltonian: "Hamiltonian", scheme: str, step_sizes: tuple[str, ...], **options: Any
) -> CommandAnswer:
    """Split Λ of a float64 run into truncation and four kinds of rounding, which add up exactly.

    Of an H(p, q, t) float64's clock, t + h + h + …, is a kind of its own.

    Of p1 … qn, W = MᵀΩM − Ω is split so, entry by entry, M the product of all steps' Jacobians.

    With several step sizes also the one below which rounding is the larger part.
    """
    from verify.arithmetic.exact import positive
    from verify.hamiltonians.run_domain import check_start
    from verify.scenes.values import describe_rounding
    from verify.studies.separation.truncation_and_rounding import RUNS, count_steps, separate_grid

    # q and p are checked before the runs, so that a missing number is refused at once.
    options |= {name: parse_coordinates(options[name], hamiltonian) for name in ("q", "p")}
    check_start(hamiltonian, options["q"], options["p"], options["t0"])
    counts = count_steps(step_sizes, options["steps"], options["time"])
    with progress_bar("stepping", RUNS * sum(n for _, n in counts)) as advance:
        options |= {"step_sizes": step_sizes, "progress": advance}
        result = separate_grid(hamiltonian, scheme, **options)
    time = options["time"]
    note = describe_rounding(time and positive(time, "time"), [h for h, _ in counts])

    def show() -> None:
        print_separation(result)
        print_once([note])

    return CommandAnswer(lambda: separation_json(result), show)
