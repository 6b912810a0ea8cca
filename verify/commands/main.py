"""The command `verify`. Heavy libraries are imported inside the command that needs them."""

import contextlib
import os
import signal
import sys
from pathlib import Path
from typing import Any

import click

from verify.commands import output as show
from verify.commands.bench import bench
from verify.commands.check import check
from verify.commands.explore import explore
from verify.commands.flow import flow
from verify.commands.input import hamiltonian_of, target, with_system, writable
from verify.commands.integrator import check_integrator
from verify.commands.output_plan import print_plan
from verify.commands.prove import certificate, prove
from verify.commands.reference import reference
from verify.commands.report import report
from verify.commands.stability import stability
from verify.errors import InputError, PlaceError

INTERRUPTED, TERMINATED = 130, 143
BAD_INPUT = 2


@click.group(
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(package_name="areaproof", prog_name="verify")
@click.pass_context
def cli(context: click.Context) -> None:
    """Verify how well a one-step scheme for p' = −H_q, q' = H_p preserves area.

    \b
    verify prove --system duffing --scheme lie2
    verify run --system duffing --param delta=1 --scheme lie2 \\
           --step-size 0.001 --steps 20000 --q 1.5 --p 0 --digits 50
    verify check claims.toml
    verify report paper -o paper-report

    Numbers are exact: 0.001 is 1/1000, 7/3 is a third of seven.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


cli.add_command(prove)
cli.add_command(certificate)
cli.add_command(explore)
cli.add_command(flow)
cli.add_command(stability)
cli.add_command(check)
cli.add_command(check_integrator)
cli.add_command(bench)
cli.add_command(reference)
cli.add_command(report)


@cli.command()
@with_system
@click.option("--step-size", required=True, metavar="H", help="Greater than 0.")
@click.option("--steps", required=True, type=int, metavar="N", help="At least 1.")
@click.option("--q", "q", required=True, metavar="Q", help="Initial displacement.")
@click.option("--p", "p", required=True, metavar="P", help="Initial momentum.")
@click.option("--digits", type=int, metavar="D", help="Significant digits wanted.")
@click.option(
    "--arithmetic",
    help="float64; auto, the fastest that certifies the digits; fixed (compiled), mpfr, mpmath or "
    "ball. Without it: float64, or auto where --digits is given.",
)
@click.option(
    "--keep",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Keep checkpoints there; the same command goes on from them.",
)
def run(
    system: str | None,
    hamiltonian: str | None,
    params: tuple[str, ...],
    scheme: str,
    as_json: bool,
    step_size: str,
    steps: int,
    q: str,
    p: str,
    digits: int | None,
    arithmetic: str | None,
    keep: Path | None,
) -> None:
    """Run N steps and report Λ, MSE, max |ΔJ| and the last state, each with its error bound.

    With --keep, an interruption costs at most some seconds of work.
    """
    from verify.commands.progress import steps_bar
    from verify.execution.keeping import Keeper, name_of
    from verify.runs.run import run as run_scheme
    from verify.scenes.values import AUTO, CLOSED_FORM, REPORTED

    exact = hamiltonian_of(system, hamiltonian, params)
    arithmetic = arithmetic or (AUTO if digits else "float64")
    if keep is not None:
        writable(keep, "--keep")
    asked = (exact.expression, exact.values, scheme, step_size, steps, q, p, digits, arithmetic)
    keeper = Keeper(keep, name_of(asked))
    with steps_bar(steps) as tell:
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
    if as_json:
        show.print_json(show.run_json(result))
    else:
        show.print_run(result)


@cli.command()
@with_system
@click.option(
    "--step-size",
    "step_sizes",
    required=True,
    multiple=True,
    metavar="H",
    help="Greater than 0; given several times, a grid of them.",
)
@click.option("--steps", type=int, metavar="N", help="At least 1; or:")
@click.option("--time", metavar="T", help="N = ⌊T/H⌋ steps for each H.")
@click.option("--q", "q", required=True, metavar="Q", help="Initial displacement.")
@click.option("--p", "p", required=True, metavar="P", help="Initial momentum.")
@click.option("--digits", type=int, default=17, metavar="D", help="Digits wanted of every part.")
@click.option(
    "--arithmetic", default="auto", help="What stands for exact: auto, fixed, mpfr, mpmath."
)
def separate(
    system: str | None,
    hamiltonian: str | None,
    params: tuple[str, ...],
    scheme: str,
    as_json: bool,
    step_sizes: tuple[str, ...],
    **options: Any,
) -> None:
    """Split Λ of a float64 run into truncation and four kinds of rounding, which add up exactly.

    With several step sizes also the one below which rounding is the larger part.
    """
    from verify.commands.progress import progress_bar
    from verify.studies.separation.separate import RUNS, grid, separate_grid

    exact = hamiltonian_of(system, hamiltonian, params)
    counts = grid(step_sizes, options["steps"], options["time"])
    with progress_bar("stepping", RUNS * sum(n for _, n in counts)) as advance:
        result = separate_grid(exact, scheme, step_sizes=step_sizes, progress=advance, **options)
    if as_json:
        show.print_json(show.separation_json(result))
    else:
        show.print_separation(result)


@cli.command()
@click.argument("scene", metavar="SCENE")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def plan(scene: str, as_json: bool) -> None:
    """Show what SCENE needs computed, what is left out, and why.

    SCENE is a TOML file, `paper`, `stiff` or `extreme`.
    """
    from verify.studies.plan import plan_scenes

    _, scenes, _ = target(scene)
    planned = plan_scenes(scenes).as_json()
    if as_json:
        show.print_json(planned)
    else:
        print_plan(planned)


# -- entry ----------------------------------------------------------------------------------------


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit.

    0 done, 1 a check failed, 2 bad input or workers lost, 130 interrupted, 143 terminated.
    """
    with contextlib.suppress(ValueError):  # not in the main thread, which alone is signalled
        signal.signal(signal.SIGTERM, _terminated)
    try:
        cli.main(args=arguments, prog_name="verify", standalone_mode=False)
        sys.stdout.flush()
    except (InputError, PlaceError) as error:
        _fail(str(error))
    except click.ClickException as error:
        _fail(error.format_message())
    except (KeyboardInterrupt, click.Abort):
        sys.exit(INTERRUPTED)
    except BrokenPipeError:  # the reader, such as head, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        _fail(f"{error.filename or 'file'}: {error.strerror or error}")


def _terminated(*_: object) -> None:
    """As an interruption: worker processes are ended, and what is finished is kept."""
    sys.exit(TERMINATED)


def _fail(message: str) -> None:
    click.echo(f"verify: {' '.join(message.split())}", err=True)
    sys.exit(BAD_INPUT)


if __name__ == "__main__":
    main()
