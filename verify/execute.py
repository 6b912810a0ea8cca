"""Tasks → results, on this process or a pool over the cores; what is finished is kept.

Each result is written by itself, atomically, as soon as it is there, under a name made of the task
and of this package's own source: an interrupted job goes on from there, and no result of other
code is taken for one of this.
"""

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from pathlib import Path

from pydantic import ValidationError

from verify.float_bounds import DIRECT_STEPS
from verify.keeping import Keeper, fingerprint, write_atomically
from verify.perform import Result, perform, result_model
from verify.planned import Plan
from verify.runs import AUTO
from verify.tasks import (
    ExploreTask,
    FlowTask,
    HuntTask,
    LargestStepTask,
    RunTask,
    SeparationTask,
    StabilityMapTask,
    StabilityTask,
    Task,
    WorkPrecisionTask,
)

Done = Callable[[str, Result], None]  # called with a task's key and its result

_VERSIONED = ("areaproof", "sympy", "python-flint", "mpmath", "gmpy2", "numba", "numpy")
_WORTH_A_POOL = 20_000_000  # float64 steps below which starting workers costs more than it gains
_CASE_COST = 2_000_000  # about what a case costs that is judged, however short
_CASES_OF_BISECTION = 20
_POINT_COST = 30_000_000  # of a point of error against run time: some tenths of a second
_SCENE_COST = 10_000  # of one property of one drawn scene
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
    plan: Plan, store: Store, *, workers: int | None = None, done: Done | None = None
) -> dict[str, Result]:
    """All results of the plan by task key; those in the store are taken from there.

    `workers`: None picks by the work there is; 1 stays in this process. On an interruption what
    is finished is in the store already.
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
    together = {name: task for name, task in waiting.items() if not task.alone}
    for name, result in _performed(together, _workers(together, workers), store):
        store.put(name, result)
        finish(name, result)
    for name, task in waiting.items():
        if name in together:
            continue
        result = perform(task, store.keeper(name))  # here, when no other is under way
        store.put(name, result)
        finish(name, result)
    return results


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
    if isinstance(task, ExploreTask):
        return _SCENE_COST * task.count * (len(task.properties) + len(task.claims))
    if isinstance(task, HuntTask):
        return 10 * _SCENE_COST * task.count
    if isinstance(task, RunTask):
        checked = task.arithmetic == "float64" and task.steps <= DIRECT_STEPS
        return task.steps * _STEP_COST.get(AUTO if checked else task.arithmetic, 500)
    return 1


def _workers(tasks: Mapping[str, Task], asked: int | None) -> int:
    if asked is not None:
        return max(1, asked)
    if sum(map(cost, tasks.values())) < _WORTH_A_POOL:
        return 1
    return max(1, min(os.cpu_count() or 1, len(tasks)))


def _performed(
    tasks: Mapping[str, Task], workers: int, store: Store
) -> Iterator[tuple[str, Result]]:
    # Longest first, so that no worker is left with a long one at the end.
    order = sorted(tasks, key=lambda name: -cost(tasks[name]))
    if workers == 1:
        for name in order:
            yield name, perform(tasks[name], store.keeper(name))
        return
    with _pool(workers) as executor:
        futures: dict[Future[Result], str] = {
            executor.submit(perform, tasks[name], store.keeper(name)): name for name in order
        }
        try:
            for future in as_completed(futures):
                name = futures.pop(future)
                yield name, future.result()
        except KeyboardInterrupt:
            # What other workers had just finished is not lost either.
            for future, name in futures.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    store.put(name, future.result())
            raise


@contextlib.contextmanager
def _pool(workers: int) -> Iterator[Executor]:
    """A process pool that an interruption ends at once."""
    # Spawned, not forked: this process may have threads (the progress bar's, a kernel's).
    context = multiprocessing.get_context("spawn")
    executor = ProcessPoolExecutor(workers, mp_context=context, initializer=_ignore_interrupts)
    try:
        yield executor
    except BaseException:
        # The executor has no public way to end a task that is running.
        for process in (executor._processes or {}).values():
            process.terminate()
        executor.shutdown(wait=False, cancel_futures=True)
        raise
    executor.shutdown()


def _ignore_interrupts() -> None:
    # Ctrl-C reaches the whole process group; the parent alone answers it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
