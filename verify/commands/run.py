"""The command `verify run`: N steps, each number with its error bound."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify import arithmetic as number_systems
from verify.commands.shared import output as show
from verify.commands.shared.answer import Answer, answering
from verify.commands.shared.input import PATH, keepable, scheme_option, with_hamiltonian

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian


@click.command()
@with_hamiltonian
@scheme_option
@answering
@click.option("--step-size", required=True, metavar="H", help="Greater than 0.")
@click.option("--steps", required=True, type=int, metavar="N", help="At least 1.")
@click.option("--q", "q", required=True, metavar="Q", help="Initial displacement.")
@click.option("--p", "p", required=True, metavar="P", help="Initial momentum.")
@click.option("--digits", type=int, metavar="D", help="Significant digits wanted.")
@click.option(
    "--arithmetic",
    help=f"{', '.join(number_systems.names())}; or auto, the fastest that certifies the digits. "
    "Without it: float64, or auto where --digits is given.",
)
@click.option(
    "--keep",
    type=PATH,
    metavar="DIR",
    help="Keep checkpoints there; the same command goes on from them.",
)
def run(
    exact: "Hamiltonian",
    scheme: str,
    step_size: str,
    steps: int,
    q: str,
    p: str,
    digits: int | None,
    arithmetic: str | None,
    keep: Path | None,
) -> Answer:
    """Run N steps and report Λ, MSE, max |ΔJ| and the last state, each with its error bound.

    With --keep, an interruption costs at most some seconds of work.
    """
    from verify.commands.shared.progress import counting_bar
    from verify.execution.keeping import Keeper, name_of
    from verify.runs.run import run as run_scheme
    from verify.scenes.values import AUTO, CLOSED_FORM, REPORTED

    arithmetic = arithmetic or (AUTO if digits else "float64")
    if keep is not None:
        keepable(keep)
    asked = (exact.expression, exact.values, scheme, step_size, steps, q, p, digits, arithmetic)
    keeper = Keeper(keep, name_of(asked))
    with counting_bar("stepping", steps) as tell:
        result = run_scheme(
            exact,
            scheme,
            q=q,
            p=p,
            step_size=step_size,
            steps=steps,
            arithmetic=arithmetic,
            digits=17 if digits is None else digits,
            # The plain way shows what rounding does to it; at many digits that is nothing.
            observables=REPORTED if arithmetic == "float64" else CLOSED_FORM,
            progress=tell,
            keeper=keeper,
        )
    keeper.clear()
    return Answer(
        lambda: show.run_json(result),
        lambda: show.print_run(result),
        failed=result.status != "finished",
    )
