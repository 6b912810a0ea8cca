"""Tasks → results, wherever they are performed; what is finished is kept.

Each result is written by itself, atomically, as soon as it is there, under a name made of the task
and of this package's own source: an interrupted job goes on from there, and no result of other
code is taken for one of this.
"""

import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from pydantic import ValidationError

from verify.execution.executors import ANYWHERE, HERE, Call, Place, Where, opened, performed
from verify.execution.keeping import NOTHING, Keeper, fingerprint, write_atomically
from verify.execution.perform import Result, perform, result_model
from verify.runs.float64 import DIRECT_STEPS
from verify.runs.run import AUTO
from verify.scenes.plan import Plan
from verify.scenes.tasks import (
    ExploreTask,
    FlowTask,
    HuntTask,
    LargestStepTask,
    OrbitTask,
    RunTask,
    SeparationTask,
    SolutionTask,
    StabilityMapTask,
    StabilityTask,
    Task,
    WorkPrecisionTask,
)

Done = Callable[[str, Result], None]  # called with a task's key and its result

_WORTH_A_POOL = 20_000_000  # float64 steps below which starting workers costs more than it gains
_CASE_COST = 2_000_000  # about what a case costs that is judged, however short
_CASES_OF_BISECTION = 20
_POINT_COST = 30_000_000  # of a point of error against run time: some tenths of a second
_SCENE_COST = 10_000  # of one property of one drawn scene
_ROW_COST = 1_000_000  # of a row of reference data, however few its steps
_FLOW_COST, _FLOW_POINTS = 20_000_000, 20_000  # of a region carried by a map
# In float64 steps; an arithmetic that is not listed counts as one in between.
_STEP_COST = {"float64": 1, "fixed": 40, "auto": 40, "mpfr": 700, "mpmath": 3000}


class Store:
    """Finished results in a folder, one JSON file each; None keeps them in memory only."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.taken = 0  # results that were found here

    def path(self, name: str) -> Path | None:
        return self.folder / f"{name}-{fingerprint()}.json" if self.folder else None

    def get(self, name: str, task: Task) -> Result | None:
        path = self.path(name)
        if path is None or not path.exists():
            return None
        try:
            found: Result = result_model(task).model_validate_json(path.read_text())
        except (ValidationError, UnicodeDecodeError):  # damaged from outside: do it again
            return None
        self.taken += 1
        return found

    def put(self, name: str, result: Result) -> None:
        path = self.path(name)
        if path is not None:
            write_atomically(path, result.model_dump_json(indent=1))
            self.keeper(name).clear()

    def keeper(self, name: str) -> Keeper:
        """What keeps the checkpoints of that task's runs."""
        return Keeper(self.folder, name)


def execute(
    plan: Plan, store: Store, *, where: Where = ANYWHERE, done: Done | None = None
) -> dict[str, Result]:
    """All results of the plan by task key; those in the store are taken from there.

    On an interruption what is finished is in the store already. A task on a cluster keeps no
    checkpoints, since its machine need not have the store's folder. Times are measured when no
    other task is under way: in this process, or on a cluster by the worker that has the task.
    PlaceError where the workers fail a task again and again.
    """
    results: dict[str, Result] = {}

    def finish(name: str, result: Result) -> None:
        results[name] = result
        if done:
            done(name, result)

    waiting: dict[str, Task] = {}
    for name, task in plan.tasks.items():
        kept = store.get(name, task)
        if kept is None:
            waiting[name] = task
        else:
            finish(name, kept)

    def take(place: Place, tasks: Mapping[str, Task], one_by_one: bool = False) -> None:
        for name, result in performed(place, _calls(tasks, store, place), one_by_one=one_by_one):
            store.put(name, result)
            finish(name, result)

    if not waiting:
        return results
    together = {name: task for name, task in waiting.items() if not task.alone}
    alone = {name: task for name, task in waiting.items() if task.alone}
    with opened(_enough(together, where)) as place:
        take(place, together)
        if not place.local:
            take(place, alone, one_by_one=True)
    if place.local:
        with opened(HERE) as place:
            take(place, alone)
    return results


def told(task: Task) -> str:
    """The task in some words, for an error."""
    given = task.model_dump(mode="json", exclude={"kind"})
    words = [f"{k}={v}" for k, v in given.items() if isinstance(v, str | int)]
    return f"{task.kind} of {', '.join(words)}"


def cost(task: Task) -> int:
    """About how many float64 steps the task is worth."""
    if isinstance(task, WorkPrecisionTask):
        return _POINT_COST * len(task.schemes) * len(task.step_sizes)
    if isinstance(task, StabilityMapTask):
        return _CASE_COST * len(task.values) * len(task.step_sizes)
    if isinstance(task, LargestStepTask):
        return _CASE_COST * _CASES_OF_BISECTION
    if isinstance(task, StabilityTask):
        return _CASE_COST + task.steps * _STEP_COST["fixed"]
    if isinstance(task, SeparationTask):
        return 3 * task.steps * _STEP_COST[AUTO]
    if isinstance(task, FlowTask):
        return _FLOW_COST + _FLOW_POINTS * task.steps
    if isinstance(task, OrbitTask):
        return _ROW_COST * len(task.steps) + _STEP_COST["mpfr"] * sum(task.steps)
    if isinstance(task, SolutionTask):
        return 10 * _ROW_COST * len(task.steps)
    if isinstance(task, ExploreTask):
        return _SCENE_COST * task.count * (len(task.properties) + len(task.claims))
    if isinstance(task, HuntTask):
        return task.count * (10 * _SCENE_COST + 3 * task.steps * _STEP_COST["mpfr"])
    if isinstance(task, RunTask):
        checked = task.arithmetic == "float64" and task.steps <= DIRECT_STEPS
        return task.steps * _STEP_COST.get(AUTO if checked else task.arithmetic, 500)
    return 1


def _enough(tasks: Mapping[str, Task], where: Where) -> Where:
    """Where nothing is said of where: so many processes as are worth their start."""
    if where != ANYWHERE:
        return where
    if sum(map(cost, tasks.values())) < _WORTH_A_POOL:
        return HERE
    return Where(workers=max(1, min(os.cpu_count() or 1, len(tasks))))


def _calls(tasks: Mapping[str, Task], store: Store, place: Place) -> Iterator[Call]:
    # Longest first, so that no worker is left with a long one at the end.
    for name in sorted(tasks, key=lambda name: -cost(tasks[name])):
        keeper = store.keeper(name) if place.local else NOTHING
        yield Call(name, perform, (tasks[name], keeper), told(tasks[name]))
