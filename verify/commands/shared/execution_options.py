"""How a command computes: options of its execution, progress, kept results.

--no-cache, --workers, --cluster and --keep are read here. Bars and clocks are drawn on standard
error, and only on a terminal.
"""

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.code_cache import OFF, VARIABLE, folder
from verify.commands.shared.destinations import OUT_FOLDER, ensure_keepable
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import answering

if TYPE_CHECKING:
    from verify.execution.execute import OnResult, Store
    from verify.execution.executors import Placement
    from verify.execution.plan import Plan
    from verify.execution.task import Task
    from verify.scenes.frozen import Frozen


def _disable_cache(context: click.Context, _: click.Parameter, is_set: bool) -> None:
    """Turn the cache off for this process and its workers if `is_set`; else check its setting."""
    if context.resilient_parsing:  # a shell that completes the line
        return
    if not is_set:
        folder()  # for its InputError: a wrong VERIFY_CACHE is refused before anything is computed
        return
    # Workers inherit the environment. The variable is put back, as tests run several commands in
    # one process; if it was not set it becomes empty, which means the same.
    previous_setting = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = OFF
    context.call_on_close(lambda: os.environ.update({VARIABLE: previous_setting}))


cache_option = flag(
    "--no-cache",
    "Read H and compile every kernel anew, and keep nothing.",
    expose_value=False,
    callback=_disable_cache,
)
keep_option = option(
    "--keep",
    "DIR",
    "Keep finished results in this folder; the same command continues from them.",
    type=OUT_FOLDER,
)
workers_option = option(
    "--workers",
    "N",
    "The number of processes; by default as many as the work is worth.",
    type=click.IntRange(1, 256),
)
cluster_option = option(
    "--cluster", "ADDRESS", "Run on the Dask cluster with this scheduler, tcp://HOST:PORT."
)


def with_placement(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --workers and --cluster, which the command gets as one `placement`, and --no-cache."""

    @wraps(command)
    def wrapper(*args: Any, workers: int | None, cluster: str | None, **options: Any) -> Any:
        from verify.execution.executors import Placement

        return command(*args, placement=Placement(workers, cluster), **options)

    return workers_option(cluster_option(cache_option(wrapper)))


def with_tasks(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --keep, --workers, --cluster, --no-cache and --json to a command."""
    return keep_option(with_placement(answering(command)))


def perform(plan: "Plan", keep: Path | None, placement: "Placement") -> "dict[str, Frozen]":
    """Perform the plan's tasks, with a progress bar, and return their results by key."""
    from verify.execution.execute import execute

    with kept_tasks(plan.tasks, keep) as (store, on_result):
        return execute(plan, store, where=placement, done=on_result)


@contextmanager
def kept_tasks(
    tasks: "Mapping[str, Task]", keep: Path | None, option: str = "--keep"
) -> "Iterator[tuple[Store, OnResult]]":
    """Yield the store of results, and the function to call with each finished task.

    A bar shows the progress. If KeyboardInterrupt ends the work, a line says how many results are
    kept, and where.
    """
    from verify.execution.execute import Store

    store = Store(keep)
    try:
        if keep is not None:
            ensure_keepable(keep, option)
        cost = sum(task.cost for task in tasks.values())
        with progress_bar(f"{len(tasks)} tasks", cost, unit="") as advance:

            def on_result(name: str, _: object) -> None:
                advance(tasks[name].cost)

            yield store, on_result
    except KeyboardInterrupt:
        if keep is not None:
            paths = map(store.path, tasks)  # a result may be written, but not reported yet
            finished = sum(path is not None and path.exists() for path in paths)
            text = f"interrupted: {finished} of {len(tasks)} tasks are kept in {keep}"
            click.echo(f"{text}; the same command goes on from there", err=True)
        raise


# -- progress --------------------------------------------------------------------------------------

Advance = Callable[[int], None]


@contextmanager
def progress_bar(label: str, total: int, unit: str = "steps") -> Iterator[Advance]:
    """Yield `advance(units)`, which does nothing if standard error is not a terminal.

    The bar shows the remaining time, and units per second if `unit` is not empty.
    """
    if not (total > 0 and sys.stderr.isatty()):
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        ProgressColumn,
        TaskProgressColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Speed(ProgressColumn):
        def render(self, task: Any) -> Text:
            return Text(f"{task.speed:,.0f} {unit}/s" if task.speed and task.speed > 0 else "")

    stream = getattr(sys.stderr, "stream", sys.stderr)  # without the escapes of `Printable`
    columns: list[ProgressColumn | str] = ["{task.description}", BarColumn(), TaskProgressColumn()]
    columns += [Speed()] if unit else []
    columns.append(TimeRemainingColumn())
    with Progress(*columns, console=Console(file=stream), transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda units: bar.advance(task, units)


@contextmanager
def counting_bar(label: str, total: int, unit: str = "steps") -> Iterator[Callable[[int], None]]:
    """Yield `advance_to(count)`, with the units done so far; it goes back if work begins anew."""
    with progress_bar(label, total, unit) as advance:
        previous_count = 0

        def advance_to(count: int) -> None:
            nonlocal previous_count
            advance(count - previous_count)
            previous_count = count

        yield advance_to


@contextmanager
def clock(label: str, after: float = 2.0) -> Iterator[None]:
    """Show the elapsed time in a line on a terminal, after the first `after` seconds."""
    if not sys.stderr.isatty():
        yield
        return
    # The work runs in this thread; another one writes the line.
    stop_event, start_time = threading.Event(), time.monotonic()
    stream = getattr(sys.stderr, "stream", sys.stderr)  # without the escapes of `Printable`

    def show_time() -> None:
        wait = after
        while not stop_event.wait(wait):
            print(
                f"\r{label} … {time.monotonic() - start_time:.0f} s",
                end="",
                file=stream,
                flush=True,
            )
            wait = 1.0

    thread = threading.Thread(target=show_time, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop_event.set()
        thread.join()
        if time.monotonic() - start_time > after:
            print("\r\x1b[K", end="", file=stream, flush=True)
