"""The command `verify separate`: truncation and four kinds of rounding in Λ, or in W."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import Answer, answering
from verify.commands.shared.cache import cache_option
from verify.commands.shared.input import listed, scheme_option, start_options, with_kept_hamiltonian
from verify.commands.shared.output import print_once
from verify.commands.shared.separation import print_separation, separation_json

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian


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
    exact: "Hamiltonian", scheme: str, step_sizes: tuple[str, ...], **options: Any
) -> Answer:
    """Split Λ of a float64 run into truncation and four kinds of rounding, which add up exactly.

    Of an H(p, q, t) float64's clock, t + h + h + …, is a kind of its own.

    Of p1 … qn, W = MᵀΩM − Ω is split so, entry by entry, M the product of all steps' Jacobians.

    With several step sizes also the one below which rounding is the larger part.
    """
    from verify.arithmetic.exact import positive
    from verify.commands.shared.progress import progress_bar
    from verify.hamiltonians.start import check_start
    from verify.scenes.values import rounded_down
    from verify.studies.separation.separate import RUNS, grid, separate_grid

    options |= {name: listed(options[name], exact) for name in ("q", "p")}
    check_start(exact, options["q"], options["p"], options["t0"])
    counts = grid(step_sizes, options["steps"], options["time"])
    with progress_bar("stepping", RUNS * sum(n for _, n in counts)) as advance:
        options |= {"step_sizes": step_sizes, "progress": advance}
        result = separate_grid(exact, scheme, **options)
    time = options["time"]
    note = rounded_down(time and positive(time, "time"), [h for h, _ in counts])

    def shown() -> None:
        print_separation(result)
        print_once([note])

    return Answer(lambda: separation_json(result), shown)
