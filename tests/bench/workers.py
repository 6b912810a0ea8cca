"""Speedups of places: one process, two, and a Dask cluster of two on this machine.

    python tests/bench/workers.py [--seconds 60] [--each 2]

The same list of about equal tasks, separations of float64 runs, each of about `--each` seconds and
all together of about `--seconds` in one process. The workers are started, and have compiled what
the tasks need, before the clock is. A machine that does other things meanwhile tells nothing.
"""

import argparse
import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

from verify.execution.execute import compute_task
from verify.execution.executors import FunctionCall, Place, Placement, open_place, results_of
from verify.execution.provenance import machine
from verify.studies.kinds.separation import SeparationTask

FEW, MANY = 400_000, 4_000_000  # steps; fewer are stepped in another way
TARGETS = {"2 workers": 1.8, "Dask, 2 workers": 1.7}
TOGETHER = 0.5  # seconds of a call that only makes sure that both of the workers are at one


def task(k: int, steps: int) -> SeparationTask:
    """One of many that differ only in where they begin."""
    return SeparationTask(
        hamiltonian="p**2/2 + q**2/2 + q**4/4", parameters={}, scheme="lie2", digits=17,
        q=1 + Fraction(k, 1000), p=Fraction(0), step_size=Fraction(1, 1000), steps=steps,
    )  # fmt: skip


def timed(k: int, steps: int) -> tuple[float, int]:
    """In the worker: the seconds that a task takes, and the peak memory so far in KiB."""
    import resource

    begun = time.perf_counter()
    compute_task(task(k, steps))
    seconds = time.perf_counter() - begun
    return seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def awake(k: int) -> None:
    """In the worker: what is compiled and imported for the tasks; then busy until all are."""
    compute_task(task(1000 + k, FEW))
    time.sleep(TOGETHER)


def steps_of(seconds: float) -> int:
    """How many a task has that takes so long: what compiling takes is there however few."""
    timed(0, FEW)
    few, many = (timed(0, steps)[0] for steps in (FEW, MANY))
    return max(FEW, round(FEW + (MANY - FEW) * (seconds - few) / max(many - few, 1e-3)))


def calls(count: int, steps: int) -> Iterator[FunctionCall]:
    return (FunctionCall(str(k), timed, (k, steps)) for k in range(count))


def measure(name: str, place: Place, count: int, steps: int, one: float | None) -> float:
    """The wall time of all tasks; prints it with the speedup over `one`."""
    for _ in range(2):  # so that each worker has had one
        list(results_of(place, (FunctionCall(str(k), awake, (k,)) for k in range(2))))
    begun = time.perf_counter()
    found = [result for _, result in results_of(place, calls(count, steps))]
    wall = time.perf_counter() - begun
    assert len(found) == count
    each = statistics.median(seconds for seconds, _ in found)
    memory = max(peak for _, peak in found) / 1024
    said = f"{name:16} {wall:7.1f} s   a task {each:5.2f} s   a worker {memory:5.0f} MiB"
    if one is not None:
        said += f"   speedup {one / wall:4.2f}, target ≥ {TARGETS[name]}"
    print(said, flush=True)
    return wall


@contextmanager
def dask_of_two() -> Iterator[Placement]:
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:  # type: ignore[no-untyped-call]
        yield Placement(cluster=cluster.scheduler_address)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60, help="of all tasks in one process")
    parser.add_argument("--each", type=float, default=2, help="of one task")
    given = parser.parse_args()
    steps = steps_of(given.each)
    count = max(4, round(given.seconds / given.each))
    print(f"{count} separations of {steps} steps each, on {machine()}")
    with open_place(Placement(1)) as place:
        one = measure("1 worker", place, count, steps, None)
    with open_place(Placement(2)) as place:
        measure("2 workers", place, count, steps, one)
    try:
        with dask_of_two() as where, open_place(where) as place:
            measure("Dask, 2 workers", place, count, steps, one)
    except ImportError:
        print("Dask: left out, distributed is not installed")


if __name__ == "__main__":
    main()
