"""Tasks → results, wherever they are computed; finished results are kept.

Each result is written by itself, atomically, as soon as it exists, under a name made of the task
and of this package's own source: an interrupted run goes on from there, and no result of other code
is mistaken for one of this.
"""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from pydantic import ValidationError

from verify.errors import InputError
from verify.execution.executors import (
    LOCAL_DEFAULT,
    THIS_PROCESS,
    FunctionCall,
    Place,
    Placement,
    open_place,
    results_of,
)
from verify.execution.keeper import (
    KEPT,
    NOTHING,
    Keeper,
    fingerprint,
    read_kept_text,
    seal,
    tasks_with_checkpoints,
)
from verify.execution.plan import MOST_AT_ONCE, Group, Plan, groups, keys_supplied_by
from verify.execution.task import Task
from verify.files import check_replaceable, clear_unfinished, write_atomically
from verify.lockstep import Course, run_together
from verify.scenes.frozen import Frozen

OnResult = Callable[[str, Frozen], None]  # it is called with the key of a task and its result

_MIN_COST_FOR_POOL = 250_000_000  # float64 steps; with fewer, starting workers does not pay


class Store:
    """Finished results in a folder, one JSON file each; None keeps them in memory only.

    A file that is damaged, or of another version of the format, is ignored: its task is done again.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.taken = 0  # the number of results that were read from here
        self._keepers: dict[str, Keeper] = {}

    @cached_property
    def _tasks_with_checkpoints(self) -> frozenset[str]:
        """The tasks of which another process has left checkpoints; searched once for all tasks."""
        return tasks_with_checkpoints(self.folder) if self.folder else frozenset()

    def path(self, name: str) -> Path | None:
        return self.folder / f"{name}-{fingerprint()}.json" if self.folder else None

    def get(self, name: str, task: Task) -> Frozen | None:
        """Return the kept result of the task; None if there is none, or if it is damaged.

        Raises InputError if something occupies the path that could not be replaced once the task is
        done.
        """
        path = self.path(name)
        if path is None:
            return None
        content = read_kept_text(KEPT, path)
        result = None
        with suppress(ValidationError):  # a sealed file that is no such result: do the task again
            result = task.result.model_validate_json(content) if content else None
        if result is None:
            check_replaceable(path)
        self.taken += result is not None
        return result

    def put(self, name: str, result: Frozen) -> None:
        """Keep the result, and remove the checkpoints of its runs."""
        path = self.path(name)
        if path is not None:
            write_atomically(path, seal(KEPT, path.stem, result.model_dump_json(indent=1)))
            keeper = self.keeper(name)
            if keeper.saved or name in self._tasks_with_checkpoints:
                keeper.clear()
        self._keepers.pop(name, None)

    def tidy(self, ended: Sequence[int]) -> None:
        """Remove unfinished files of processes that were ended."""
        if self.folder is not None:
            clear_unfinished(self.folder, ended)

    def keeper(self, name: str) -> Keeper:
        """Return the keeper of the checkpoints of that task's runs."""
        return self._keepers.setdefault(name, Keeper(self.folder, name))


def execute(
    plan: Plan, store: Store, *, where: Placement = LOCAL_DEFAULT, done: OnResult | None = None
) -> dict[str, Frozen]:
    """Return all results of the plan by the keys of the tasks; those in the store are read.

    - Every finished result is in the store at once, so that an interruption does not lose it.
    - A task on a cluster keeps no checkpoints, since its machine need not have the store's folder.
    - A task that measures times (`alone`) runs while no other is under way: in this process, or in
      a worker of a cluster. If there are workers on this machine, they prepare it before, beside
      the others.

    Raises PlaceError if a task loses its worker in every attempt.
    """
    results: dict[str, Frozen] = {}

    def finish(name: str, result: Frozen) -> None:
        # A result that comes with another task's may be in `results` already.
        is_reported = name in results or name not in plan.tasks
        results.setdefault(name, result)
        if done and not is_reported:
            done(name, result)

    waiting: dict[str, Task] = {}
    for name, task in plan.tasks.items():
        stored = store.get(name, task)
        if stored is None:
            waiting[name] = task
        else:
            finish(name, stored)
    supplied = {
        name: waiting.pop(name) for name in keys_supplied_by(waiting.values()) if name in waiting
    }
    together = {name: task for name, task in waiting.items() if not task.alone}
    alone = {name: task for name, task in waiting.items() if task.alone}

    def compute_tasks(place: Place, tasks: Mapping[str, Task], one_by_one: bool = False) -> None:
        parts = groups(tasks, place.room)
        if place.room == 0:
            for part in parts:
                # Each result is stored at once: a group may be interrupted, or lose its worker,
                # after some of its tasks.
                for name, result in _compute_together(part, store):
                    store.put(name, result)
                    finish(name, result)
            return
        for name_of_call, results_of_call in results_of(
            place, _calls(parts, store, place), one_by_one=one_by_one
        ):
            if place.local and name_of_call in alone:
                store.keeper(name_of_call).prepared = results_of_call
                continue
            # A local worker has put the result into the store already; one of a cluster cannot
            # reach the folder.
            for name, result in results_of_call.items():
                if not place.local:
                    store.put(name, result)
                finish(name, result)

    if not waiting:
        return results
    count = len(waiting)
    with open_place(
        _choose_placement(together, count, where), _modules(waiting), store.tidy
    ) as place:
        prepared_beside = alone if place.local and place.room and count > 1 else {}
        compute_tasks(place, {**together, **prepared_beside})
        compute_tasks(place, {name: task for name, task in supplied.items() if name not in results})
        if not place.local:
            compute_tasks(place, alone, one_by_one=True)
    if place.local:
        with open_place(THIS_PROCESS) as place:
            compute_tasks(place, alone)
    return results


def compute_task(task: Task, keeper: Keeper = NOTHING) -> Frozen:
    """Compute one task, in this process."""
    return task.compute(keeper)


def prepare_task(task: Task) -> object:
    """Prepare a task; return None if its input is bad, so that `compute` reports it in its turn."""
    try:
        return task.prepare()
    except InputError:
        return None


def compute_all(task: Task, keeper: Keeper) -> Course[dict[str, Frozen]]:
    """Compute one task; the course ends with its result and those of `gives`, by their keys."""
    return task.compute_in_turn(keeper)


def _modules(tasks: Mapping[str, Task]) -> list[str]:
    """Return the modules that workers import before their first call, once for all of them."""
    kinds = {type(task) for task in tasks.values()}
    modules = {name for kind in kinds for name in (kind.__module__, *kind.imports)}
    return sorted({*modules, "sympy"})  # every task parses its H by sympy, which is imported late


def _choose_placement(tasks: Mapping[str, Task], calls: int, requested: Placement) -> Placement:
    """Return the requested placement; for the default, as many processes as are worth their start.

    `tasks`: those that are computed together. Preparations alone are worth no process.
    """
    if requested != LOCAL_DEFAULT:
        return requested
    if sum(task.cost for task in tasks.values()) < _MIN_COST_FOR_POOL:
        return THIS_PROCESS
    return Placement(workers=max(1, min(os.cpu_count() or 1, calls)))


def _compute_together(part: Group, store: Store) -> Iterator[tuple[str, Frozen]]:
    """Compute a group of tasks in this process; yield their results, and those of their `gives`.

    Exceptions of a task are raised.
    """
    courses = (compute_all(task, store.keeper(name)) for name, task in part.items())
    for _, course in run_together(courses, MOST_AT_ONCE):
        yield from course.result().items()


def compute_group(group: Group, store: Store) -> dict[str, Frozen]:
    """Compute a group in a worker, which keeps each result in the store as soon as it exists."""
    results = {}
    for name, result in _compute_together(group, store):
        store.put(name, result)
        results[name] = result
    return results


def _calls(parts: Sequence[Group], store: Store, place: Place) -> Iterator[FunctionCall]:
    # Longest first, so that no worker is left with a long one at the end.
    for part in parts:
        name, task = next(iter(part.items()))
        if place.local and task.alone:  # a worker prepares it; it is computed in this process
            yield FunctionCall(name, prepare_task, (task,), task.description)
            continue
        worker_store = store if place.local else Store(None)
        more = f" and {len(part) - 1} more" if len(part) > 1 else ""
        yield FunctionCall(name, compute_group, (part, worker_store), task.description + more)
