"""The commands `verify reference make` and `check`: numbers for others to test against."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify import show
from verify.cli_input import writable
from verify.cli_tasks import json_option, told, with_tasks
from verify.errors import InputError

if TYPE_CHECKING:
    from reference.check import Checked
    from verify.executors import Where

DIFFERENT = 1  # exit status
_SHARE = 0.05


@click.group()
def reference() -> None:
    """Reference data: numbers whose every digit is known, to test an integrator against."""


@reference.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR")
@click.option("--parquet", is_flag=True, help="The tables as Parquet, too; wants pyarrow.")
@with_tasks
def make(
    scenes: tuple[str, ...],
    output: Path | None,
    parquet: bool,
    keep: Path | None,
    where: "Where",
    as_json: bool,
) -> None:
    """Make the reference data that SCENE asks for, in DIR; without SCENE, the committed set.

    SCENE is a TOML file with [[reference]] sections. The same scene gives the same bytes, however
    many workers there are. With --keep an interrupted command goes on from what is finished.

    \b
    [[reference]]
    step_sizes = [0.001, 0.01]
    initial_values = [{ q = 1.5, p = 0 }]
    steps = [0, 1, 10, 100, 1000]     # after which state, ΔJ, MSE and Λ are given
    digits = 30
    """
    from reference import make as making
    from verify.execute import Store, execute
    from verify.reference_plan import plan_references

    if parquet:
        from reference.parquet import require

        require()
    asked = making.load([Path(x) for x in scenes] or making.committed_scenes())
    folder = output or Path(f"{asked[0].scene.name}-reference" if scenes else "reference-data")
    writable(folder)
    if keep is not None:
        writable(keep, "--keep")
    plan = plan_references([x.scene for x in asked])
    with told(plan.tasks, keep) as done:
        results = execute(plan, Store(keep), where=where, done=done)
    data = [making.data_of(x.scene, results) for x in asked]
    files = making.files_of(data, parquet=parquet)
    manifest = making.manifest_of(asked, files, making.command_of(scenes, parquet))
    making.write(folder, files, manifest)
    rows = sum(len(x.rows) for each in data for x in (*each.runs, *each.flow))
    size = sum(map(len, files.values()))
    if as_json:
        found: dict[str, Any] = {"directory": str(folder), "rows": rows, "bytes": size}
        show.print_json(found | {"files": [x.model_dump(mode="json") for x in manifest.files]})
    else:
        click.echo(f"{rows:,} rows in {len(files)} files, {size:,} bytes → {folder}")
