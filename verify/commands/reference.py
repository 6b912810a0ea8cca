"""The commands `verify reference make` and `check`: numbers for others to test against.

`verify reference compare` is in `verify.commands.reference_compare`.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.reference_compare import compare
from verify.commands.shared import execution_options
from verify.commands.shared.command_group import CommandGroup
from verify.commands.shared.destinations import OUT_FOLDER, ensure_writable
from verify.commands.shared.input import FILE, PATH
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering, pick
from verify.errors import NOT_GIVEN, InputError, without_controls

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.reference.check.folder_check import CheckResult

_DEFAULT_SHARE = 0.05  # the part of the data that `check` recomputes
_DEFAULT_STEP_LIMIT = 10**6  # a minute or two


@click.group(cls=CommandGroup)
def reference() -> None:
    """Reference data: numbers whose every digit is known, to test an integrator against."""


reference.add_command(compare)


@reference.command()
@click.argument("scenes", type=FILE, nargs=-1, metavar="[SCENE]...")
@option(
    "-o --output",
    "DIR",
    "The folder to write into.  [default: SCENE-reference, or reference-data]",
    type=OUT_FOLDER,
)
@flag("--parquet", "Write the tables as Parquet too, which needs pyarrow.")
@execution_options.with_tasks
def make(
    scenes: tuple[str, ...],
    output: Path | None,
    parquet: bool,
    keep: Path | None,
    placement: "Placement",
) -> CommandAnswer:
    """Make the reference data that SCENE asks for, in DIR; without SCENE, the committed set.

    SCENE is a TOML file with [[reference]] sections. The same scene gives the same bytes, however
    many workers there are. With --keep an interrupted command continues from the finished tasks.

    \b
    [[reference]]
    step_sizes = [0.001, 0.01]
    initial_values = [{ q = 1.5, p = 0 }]
    steps = [0, 1, 10, 100, 1000]     # after which state, ΔJ, MSE and Λ are given
    digits = 30
    """
    from verify.reference.make import data_folder as making
    from verify.reference.make.scene_plan import plan_references

    if parquet:
        from verify.reference.make.file_contents import require_pyarrow

        require_pyarrow()
    sources = making.load([Path(x) for x in scenes] or making.committed_scenes())
    folder = output or Path(f"{sources[0].scene.name}-reference" if scenes else "reference-data")
    ensure_writable(folder)
    making.check_is_alone(folder, sources, parquet=parquet)
    results = execution_options.perform(
        plan_references([x.scene for x in sources]), keep, placement
    )
    data = [making.data_of(x.scene, results) for x in sources]
    files = making.files_of(data, parquet=parquet)
    manifest = making.manifest_of(sources, files, making.command_of(scenes, parquet))
    making.write(folder, files, manifest)
    rows = sum(data_set.count for data_set in data)
    size = sum(map(len, files.values()))
    summary: dict[str, Any] = {"directory": str(folder), "rows": rows, "bytes": size}
    return CommandAnswer(
        lambda: summary | {"files": [x.model_dump(mode="json") for x in manifest.files]},
        lambda: click.echo(f"{rows:,} rows in {len(files)} files, {size:,} bytes → {folder}"),
    )


@reference.command()
@click.argument("folder", required=False, type=PATH, metavar="[DIR]")
@option("--share", "X", "The part of the data that is recomputed, 0 … 1.", default=_DEFAULT_SHARE)
@flag("--all everything", "Recompute all of them.")
@option(
    "--most-steps",
    "N",
    "The limit on the steps of all recomputed runs; the others are named.  "
    f"[default: {_DEFAULT_STEP_LIMIT:,}; none with --all]",
    type=click.IntRange(1),
)
@option(
    "--seed", "S", "The seed of the random sample; by default a random one.", type=click.IntRange(0)
)
@execution_options.with_placement
@answering
def check(
    folder: Path | None,
    share: float,
    everything: bool,
    most_steps: int | None,
    seed: int | None,
    placement: "Placement",
) -> CommandAnswer:
    """Check the reference data in DIR; without it, the committed set.

    Checked are hashes, sizes, schemas, the forms of a table against each other and how every number
    is printed; and a random sample is computed again in ball arithmetic, from the textbook's
    formulas. Exit status 1 if anything differs; the first difference is printed.
    """
    from random import SystemRandom

    from verify.reference.check import folder_check as checking
    from verify.reference.make.data_folder import PUBLISHED, SCENES

    if not 0 <= share <= 1:
        raise InputError("--share", share, "must be 0 … 1")
    if everything and share != _DEFAULT_SHARE:
        raise InputError("--all", NOT_GIVEN, "goes without --share")
    if most_steps is None and not everything:
        most_steps = _DEFAULT_STEP_LIMIT
    seed = SystemRandom().randrange(10**6) if seed is None else seed
    # The bar counts thousandths, as only the check knows the total, and reports it with each count.
    with execution_options.counting_bar("recomputed", 1000, unit="") as advance:
        report = checking.check(
            folder or PUBLISHED,
            share=1.0 if everything else share,
            seed=seed,
            scenes_folder=SCENES if folder is None else None,
            most_steps=most_steps,
            where=placement,
            done=lambda count, total: advance(1000 * count // total),
        )
    return CommandAnswer(
        lambda: _as_json(report), lambda: _print(report), failed=bool(report.differences)
    )


def _as_json(report: "CheckResult") -> dict[str, Any]:
    return {
        "agrees": not report.differences,
        **pick(report, "files", "rows", "recomputed", "seed"),
        "differences": [x.as_json() for x in report.differences],
        **pick(report, "not_recomputed", "not_compared"),
    }


def _print(report: "CheckResult") -> None:
    for line in (*report.not_recomputed, *report.not_compared):
        click.echo(f"not looked at: {without_controls(line)}")
    recomputation = f"{report.recomputed:,} computed again (--seed {report.seed})"
    if report.differences:
        further = len(report.differences) - 1
        click.echo(
            f"DIFFERS: {report.differences[0]}" + (f"; and {further:,} more" if further else "")
        )
    else:
        click.echo(f"agrees: {report.files} files, {report.rows:,} rows, of which {recomputation}")
