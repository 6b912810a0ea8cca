"""The command `verify bench`: error against run time, for the schemes of a scene."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.destinations import OUT_FILE
from verify.commands.shared.execution_options import cache_option, cluster_option, progress_bar
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering, plain_json
from verify.commands.shared.scene_options import scenes_of, start_options, with_one_line
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from rich.table import Table

    from verify.scenes.results.bounded_value import Value
    from verify.scenes.results.work_precision import WorkLine, WorkPoint, WorkPrecisionResult
    from verify.scenes.scene import Scene


# The columns of errors: the head of each column, and the field of a `WorkPoint`. The last one is
# the defect of the structure that schemes should keep.
_ERRORS_IN_THE_PLANE = {"error": "error", "Λ": "lam"}
_ERRORS_IN_DEGREES = {
    "error": "error",
    "energy": "energy",
    "Λ": "lam",
    "max |W|": "symplectic_defect",
}


@click.command()
@with_one_line(
    option("--time", "T", "The end time T; N is T/H rounded down."),
    option("--repeats", "N", "Timings of each point.  [default: 5]", type=int),
    flag("--peers", "Measure solvers of other libraries too."),
)
@start_options
@option("-o --output", "FILE.svg", "Draw the figure into this file.", type=OUT_FILE)
@cluster_option
@answering
@cache_option
def bench(
    scene: str | None, output: Path | None, cluster: str | None, **options: Any
) -> CommandAnswer:
    """Measure error against run time in SCENE, a TOML file with a [work_precision].

    \b
    verify bench my.toml -o work-precision.svg
    verify bench --system pendulum --scheme lie2 --scheme rk4 --q 1 --p 0 --time 10 \\
           --step-size 0.1 --step-size 0.05 --step-size 0.025
    """
    if output is not None and output.suffix != ".svg":
        raise InputError("--output", str(output), "must end in .svg")
    scenes = scenes_of(scene, options, ("q", "p", "time"), _build_section)
    selected = [scene_of_work for scene_of_work in scenes if scene_of_work.work_precision]
    if not selected:
        raise InputError("SCENE", scene or NOT_GIVEN, "has no [work_precision]; add one")
    results = list(
        _measure(selected) if cluster is None else _measure_on_cluster(selected, cluster)
    )
    if output is not None:
        for name, result in results:
            # A single figure has the typed name; to each of several its scene's name is added.
            several = len(results) > 1
            _draw(result, output.with_stem(f"{output.stem}-{name}") if several else output)
    return CommandAnswer(lambda: _bench_json(results), lambda: _print(results))


def _build_section(
    *, q: Any, p: Any, step_sizes: Sequence[str], peers: bool = False, **keys_of_section: Any
) -> dict[str, Any]:
    # The order is the slope of a line through the points of at least two step sizes.
    if len(step_sizes) < 2:
        raise InputError("step_sizes", step_sizes[0], "is one; an order takes two at least")
    keys = {"initial_value": {"q": q, "p": p}, "peers": peers, "step_sizes": step_sizes}
    return {"work_precision": {**keys, **keys_of_section}}


def _measure(scenes: "list[Scene]") -> "Iterator[tuple[str, WorkPrecisionResult]]":
    from verify.studies.kinds.work_precision import work_precision_task
    from verify.studies.work_precision import peers

    for scene in scenes:
        task = work_precision_task(scene)
        total = len(task.schemes) * len(task.step_sizes)
        total += sum(len(peers.get(name).TOLERANCES) for name in task.peers)
        with progress_bar(f"{scene.name}, errors", total, unit="") as advance:
            yield scene.name, task.measure(advance)


def _measure_on_cluster(
    scenes: "list[Scene]", cluster: str
) -> "Iterator[tuple[str, WorkPrecisionResult]]":
    """Measure on the cluster, one scene after another; each result names its machine."""
    # Two tasks at a time would share processors and caches, and slow each other down.
    from verify.execution.execute import compute_task
    from verify.execution.executors import FunctionCall, Placement, open_place, results_of
    from verify.studies.kinds.work_precision import work_precision_task

    calls = [
        FunctionCall(scene.name, compute_task, (work_precision_task(scene),), f"scene {scene.name}")
        for scene in scenes
    ]
    with open_place(Placement(cluster=cluster)) as executor:
        yield from results_of(executor, calls, one_by_one=True)


def _draw(result: "WorkPrecisionResult", path: Path) -> None:
    from verify.files import write_atomically
    from verify.pages.figures.work_precision_plots import standalone

    write_atomically(path, standalone(result))


# -- output ---------------------------------------------------------------------------------------


def _bench_json(results: "Sequence[tuple[str, WorkPrecisionResult]]") -> dict[str, Any]:
    """Return the points of all scenes, each with its scene's name, and the rest of each scene."""
    return {
        "points": [
            {"scene": name, **_point_json(point)}
            for name, result in results
            for line in result.lines
            for point in line.points
        ],
        "scenes": [{"name": name, **_other_keys(result)} for name, result in results],
    }


def _point_json(point: "WorkPoint") -> dict[str, Any]:
    values = {
        "error": point.error,
        "truncation": point.truncation,
        "rounding": point.rounding,
        "energy_error": point.energy,
        "lambda": point.lam,
        "lambda_plain": point.lam_plain,
        "symplectic_defect": point.symplectic_defect,
    }
    other_fields = point.model_dump(mode="json", exclude={"energy", "lam", "lam_plain", *values})
    return {
        **other_fields,
        **{name: value.value if value else None for name, value in values.items()},
        "error_bound": {name: value.bound for name, value in values.items() if value},
    }


def _other_keys(result: "WorkPrecisionResult") -> dict[str, Any]:
    """Return all keys of a result but the points of its lines."""
    data = plain_json(result)
    lines = [{k: v for k, v in line.items() if k != "points"} for line in data.pop("lines")]
    return {**data, "lines": lines}


def _print(results: "Sequence[tuple[str, WorkPrecisionResult]]") -> None:
    for name, result in results:
        _print_bench(name, result)


def _print_bench(name: str, result: "WorkPrecisionResult") -> None:
    from rich.console import Console

    console = Console(highlight=False)
    console.print(_table(name, result))
    *_, defect_name = _error_columns(result)
    for line in result.lines:
        console.print(_describe_line(line, defect_name))
    for system in result.systems:
        outcome = f"{system.certified} certified digits" if system.certified else system.reason
        arithmetic = f"{system.arithmetic}, {system.digits} digits"
        console.print(f"{arithmetic}: {outcome} in {_format_seconds(system.seconds_median)} s")
    if result.rounded_down:
        console.print(result.rounded_down)
    for comparison in result.comparisons:
        console.print(comparison.sentence)
    for item, reason in result.left_out:
        console.print(f"not drawn: {item} ({reason})")
    console.print(
        f"{result.clock} on {result.machine}, {result.repeats} rounds; reference: "
        f"{result.reference}, to within {result.reference_bound}; {result.seconds:.3g} s in all"
    )


def _error_columns(result: "WorkPrecisionResult") -> dict[str, str]:
    from verify.structures import AREA

    return _ERRORS_IN_THE_PLANE if result.structure is AREA else _ERRORS_IN_DEGREES


def _table(name: str, result: "WorkPrecisionResult") -> "Table":
    from rich import box
    from rich.table import Table

    errors = _error_columns(result)
    title = f"{name}: error at T = {result.time} against run time"
    table = Table(
        title=title,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        collapse_padding=True,
    )
    for head in ("scheme", "h or tol.", "N", *errors, "seconds", "limited by"):
        is_text = head in ("scheme", "limited by")
        table.add_column(head, justify="left" if is_text else "right", no_wrap=not is_text)
    for line in result.lines:
        for k, point in enumerate(line.points):
            table.add_row("" if k else line.name, *_build_row(point, errors.values()))
        table.add_section()
    return table


def _build_row(point: "WorkPoint", errors: "Iterable[str]") -> tuple[str, ...]:
    limit = f"failed, step {point.failed_step}" if point.failed_step else point.limited_by
    return (
        point.step_size or point.tolerance or "",
        "" if point.steps is None else str(point.steps),
        *(_format_error(getattr(point, name)) for name in errors),
        _format_seconds(point.seconds_median),
        limit,
    )


def _describe_line(line: "WorkLine", defect_name: str) -> str:
    if line.peer:
        return f"{line.name}: made ready in {line.compile_seconds:.2g} s"
    slopes = []
    for quantity, slope in (("error", line.error_slope), (defect_name, line.lambda_slope)):
        slope_text = f"{slope.value} ± {slope.standard_error}" if slope.value else "none"
        reason_note = f" ({slope.reason})" if slope.reason else ""
        slopes.append(f"order of {quantity} {slope_text}{reason_note}")
    operations = f"; a step is {line.cost.text}" if line.cost else ""
    return f"{line.name}: {'; '.join(slopes)}{operations}; compiled in {line.compile_seconds:.2g} s"


def _format_error(value: "Value | None") -> str:
    if value is None:
        return "–"
    return f"{float(value.value):.1e}" if float(value.value) else "0"


def _format_seconds(seconds: float | None) -> str:
    return "–" if seconds is None else f"{seconds:.2e}"
