"""Tasks → results, on this process or a pool over the cores; what is finished is kept.

Each result is written by itself, atomically, as soon as it is there, under a name made of the task
and of this package's own source: an interrupted job goes on from there, and no result of other
code is taken for one of this.
"""

import contextlib
import multiprocessing
import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from pathlib import Path

from pydantic import ValidationError

from verify.exact import text
from verify.float_bounds import DIRECT_STEPS
from verify.formula import to_text
from verify.hamiltonian import Hamiltonian
from verify.keeping import NOTHING, Keeper, fingerprint, write_atomically
from verify.plan import EveryTask, GrowthTask, Plan, ProofTask, RunTask, SeparationTask, Task
from verify.proof.order import prove
from verify.results import AverageResult, EveryResult, ProofResult, RunResult, SeparationResult
from verify.runs import AUTO, run
from verify.schemes import get
from verify.separation import separate
from verify.step_map import grouped

Result = ProofResult | RunResult | SeparationResult | AverageResult | EveryResult
_MODELS: dict[str, type[Result]] = {
    "proof": ProofResult,
    "run": RunResult,
    "separation": SeparationResult,
    "growth": AverageResult,
    "every": EveryResult,
}
Done = Callable[[str, Result], None]  # called with a task's key and its result

_VERSIONED = ("areaproof", "sympy", "python-flint", "mpmath", "gmpy2", "numba", "numpy")
_WORTH_A_POOL = 20_000_000  # float64 steps below which starting workers costs more than it gains
# In float64 steps; an arithmetic that is not listed counts as one in between.
_STEP_COST = {"float64": 1, "fixed": 40, "auto": 40, "mpfr": 700, "mpmath": 3000}


def perform(task: Task, keeper: Keeper = NOTHING) -> Result:
    """Do one task; a run goes on from the checkpoint that the keeper may have."""
    if isinstance(task, EveryTask):
        return _every(task.scheme)
    hamiltonian = Hamiltonian.parse(task.hamiltonian, task.parameters)
    if isinstance(task, ProofTask):
        return _proof(hamiltonian, task.scheme)
    if isinstance(task, GrowthTask):
        return _growth(hamiltonian, task)
    if isinstance(task, SeparationTask):
        return separate(
            hamiltonian,
            task.scheme,
            q=task.q,
            p=task.p,
            step_size=task.step_size,
            steps=task.steps,
            digits=task.digits,
            keeper=keeper,
        )
    return run(
        hamiltonian,
        task.scheme,
        q=task.q,
        p=task.p,
        step_size=task.step_size,
        steps=task.steps,
        arithmetic=task.arithmetic,
        digits=task.digits,
        observables=task.observables,
        points=task.points,
        keeper=keeper,
    )


def _growth(hamiltonian: Hamiltonian, task: GrowthTask) -> AverageResult:
    from verify.growth import average_of

    return average_of(hamiltonian, task.scheme, q=task.q, p=task.p, digits=task.digits)


def _proof(hamiltonian: Hamiltonian, scheme: str) -> ProofResult:
    begun = time.perf_counter()
    step_map = get(scheme).step_map(hamiltonian)
    proof = prove(step_map, get(scheme))
    closed, p_next, q_next, jacobian = step_map.closed, None, None, None
    if closed is not None:
        written = (closed.p_next, closed.q_next, *closed.jacobian)
        p_next, q_next, a, b, c, d = (to_text(grouped(closed.ring, x)) for x in written)
        jacobian = (a, b), (c, d)
    return ProofResult(
        hamiltonian=to_text(hamiltonian.expression),
        parameters={name: text(value) for name, value in hamiltonian.values},
        scheme=scheme,
        verdict=proof.verdict,
        reason=proof.reason,
        order=proof.order,
        leading=proof.first.text,
        delta_j=step_map.delta_j_text,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        witness={name: text(value) for name, value in proof.witness.items()},
        enclosure=proof.enclosure,
        p_next=p_next,
        q_next=q_next,
        jacobian=jacobian,
        seconds=time.perf_counter() - begun,
    )


def _every(scheme: str) -> EveryResult:
    from verify.proof.every import prove_every

    proof = prove_every(scheme)
    return EveryResult(
        **{name: getattr(proof, name) for name in EveryResult.model_fields},
    )


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
            found: Result = _MODELS[task.kind].model_validate_json(path.read_text())
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
    for name, result in _performed(waiting, _workers(waiting, workers), store):
        store.put(name, result)
        finish(name, result)
    return results


def cost(task: Task) -> int:
    """About how many float64 steps the task is worth."""
    if isinstance(task, SeparationTask):
        return 3 * task.steps * _STEP_COST[AUTO]
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
