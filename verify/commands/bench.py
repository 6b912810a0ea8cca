"""The command `verify bench`: error against run time of one scene."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands import output_bench as show_bench
from verify.commands.input import target
from verify.commands.output import print_json
from verify.commands.tasks import cluster_option
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.results.work_precision import WorkPrecisionResult
    from verify.scenes.scene import Scene
    from verify.studies.work_precision.task import WorkPrecisionTask


@click.command()
@click.argument("scene", metavar="SCENE")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE.svg", help="Draw it there."
)
@cluster_option
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def bench(scene: str, output: Path | None, cluster: str | None, as_json: bool) -> None:
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
    found = list(_measured(asked) if cluster is None else _measured_there(asked, cluster))
    for name, result in found:
        if output is not None:
            several = len(found) > 1
            _draw(result, output.with_stem(f"{output.stem}-{name}") if several else output)
        if not as_json:
            show_bench.print_bench(name, result)
    if as_json:
        print_json(show_bench.bench_json(found))


def _measured(scenes: "list[Scene]") -> "Iterator[tuple[str, WorkPrecisionResult]]":
    from verify.commands.progress import progress_bar
    from verify.studies.work_precision import peers

    for scene in scenes:
        task = _task(scene)
        total = len(task.schemes) * len(task.step_sizes)
        total += sum(len(peers.get(name).TOLERANCES) for name in task.peers)
        with progress_bar(f"{scene.name}, errors", total, unit="") as advance:
            yield scene.name, task.measure(advance)


def _measured_there(
    scenes: "list[Scene]", cluster: str
) -> "Iterator[tuple[str, WorkPrecisionResult]]":
    """On the cluster, one after another: the times are of the machine that each result names."""
    from verify.execution.execute import perform
    from verify.execution.executors import Call, Where, opened, performed

    calls = [Call(each.name, perform, (_task(each),), f"scene {each.name}") for each in scenes]
    with opened(Where(cluster=cluster)) as place:
        yield from performed(place, calls, one_by_one=True)


def _task(scene: "Scene") -> "WorkPrecisionTask":
    from verify.studies.work_precision.plan import work_precision_task

    assert scene.work_precision is not None  # noqa: S101 - the caller's condition
    return work_precision_task(scene, scene.work_precision)


def _draw(result: "WorkPrecisionResult", path: Path) -> None:
    from verify.execution.keeping import write_atomically
    from verify.pages.figures.work_precision_plots import standalone

    try:
        write_atomically(path, standalone(result))
    except OSError as error:
        problem = error.strerror or "cannot be written"
        raise InputError("--output", str(path), problem) from None
