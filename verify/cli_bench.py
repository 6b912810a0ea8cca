"""The command `verify bench`: error against run time of one scene."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify import show_bench
from verify.cli_input import target
from verify.errors import InputError
from verify.show import print_json

if TYPE_CHECKING:
    from verify.scene import Scene
    from verify.work_precision_results import WorkPrecisionResult


@click.command()
@click.argument("scene", metavar="SCENE")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE.svg", help="Draw it there."
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def bench(scene: str, output: Path | None, as_json: bool) -> None:
    """Error against run time of the schemes in SCENE, a TOML file with a [work_precision].

    \b
    verify bench my.toml -o work-precision.svg
    """
    if output is not None and output.suffix != ".svg":
        raise InputError("--output", str(output), "must end in .svg")
    _, scenes, _ = target(scene)
    asked = [each for each in scenes if each.work_precision]
    if not asked:
        raise InputError("scene", scene, "has no [work_precision]")
    found = [(each.name, _measured(each)) for each in asked]
    for name, result in found:
        if output is not None:
            several = len(found) > 1
            _draw(result, output.with_stem(f"{output.stem}-{name}") if several else output)
        if not as_json:
            show_bench.print_bench(name, result)
    if as_json:
        print_json(show_bench.bench_json(found))


def _measured(scene: "Scene") -> "WorkPrecisionResult":
    from verify import peers
    from verify.progress import progress_bar
    from verify.section_plan import work_precision_task
    from verify.work_precision import work_precision

    assert scene.work_precision is not None  # noqa: S101 - the caller's condition
    task = work_precision_task(scene, scene.work_precision)
    total = len(task.schemes) * len(task.step_sizes)
    total += sum(len(peers.get(name).TOLERANCES) for name in task.peers)
    with progress_bar(f"{scene.name}, errors", total, unit="") as advance:
        return work_precision(scene.exact_hamiltonian(), task, advance)


def _draw(result: "WorkPrecisionResult", path: Path) -> None:
    from reports.work_precision_plots import standalone
    from verify.keeping import write_atomically

    try:
        write_atomically(path, standalone(result))
    except OSError as error:
        problem = error.strerror or "cannot be written"
        raise InputError("--output", str(path), problem) from None
