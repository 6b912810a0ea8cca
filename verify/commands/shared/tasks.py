"""Options, progress and kept results of commands that perform the tasks of a plan."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import answering
from verify.commands.shared.cache import cache_option
from verify.commands.shared.destinations import OUT_FOLDER, ensure_keepable

if TYPE_CHECKING:
    from verify.execution.execute import OnResult, Store
    from verify.execution.executors import Placement
    from verify.execution.plan import Plan
    from verify.execution.task import Task
    from verify.scenes.frozen import Frozen

keep_option = click.option(
    "--keep",
    type=OUT_FOLDER,
    metavar="DIR",
    help="Keep what is finished there; the same command goes on from it.",
)
workers_option = click.option(
    "--workers",
    type=click.IntRange(1, 256),
    metavar="N",
    help="Processes; without it, as many as the work is worth.",
)
cluster_option = click.option(
    "--cluster",
    metavar="ADDRESS",
    help="Run them on the Dask cluster whose scheduler is there, tcp://HOST:PORT.",
)


def with_placement(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --workers and --cluster, which the command gets as one `where`, and --no-cache."""

    @wraps(command)
    def wrapper(*args: Any, workers: int | None, cluster: str | None, **options: Any) -> Any:
        from verify.execution.executors import Placement

        return command(*args, where=Placement(workers, cluster), **options)

    return workers_option(cluster_option(cache_option(wrapper)))


def with_tasks(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --keep, --workers, --cluster, --no-cache and --json to a command."""
    return keep_option(with_placement(answering(command)))


def perform(plan: "Plan", keep: Path | None, where: "Placement") -> "dict[str, Frozen]":
    """Perform the plan's tasks, with a progress bar, and return their results by key."""
    from verify.execution.execute import execute

    with kept_tasks(plan.tasks, keep) as (store, on_result):
        return execute(plan, store, where=where, done=on_result)


@contextmanager
def kept_tasks(
    tasks: "Mapping[str, Task]", keep: Path | None, option: str = "--keep"
) -> "Iterator[tuple[Store, OnResult]]":
    """Yield the store of results, and the function to call with each finished task.

    A bar shows the progress; after an interruption a line says what is kept where.
    """
    from verify.commands.shared.progress import progress_bar
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
            paths = map(store.path, tasks)  # one may be written and not yet told
            finished = sum(path is not None and path.exists() for path in paths)
            text = f"interrupted: {finished} of {len(tasks)} tasks are kept in {keep}"
            click.echo(f"{text}; the same command goes on from there", err=True)
        raise
