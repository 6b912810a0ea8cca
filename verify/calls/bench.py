"""`verify.bench`: error against run time."""

from typing import Any

from verify.arithmetic.exact import Exact
from verify.calls.given import GivenParameters, GivenSystem, listed, scene_of
from verify.calls.progress import Progress, progress_of
from verify.errors import InputError
from verify.hamiltonians.start import Given
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.kinds.work_precision import work_precision_task


def bench(
    system: GivenSystem,
    scheme: Any,
    *,
    q: Given,
    p: Given,
    step_sizes: Any,
    time: Exact,
    t0: Exact = 0,
    parameters: GivenParameters = None,
    repeats: int = 5,
    peers: bool = False,
    progress: Progress = None,
) -> WorkPrecisionResult:
    """Solution error at `time` against run time in seconds, and area error, of schemes.

    The arguments are those of `verify.run`; `scheme` may be a list. `step_sizes`: two at least;
    N is time/h, rounded down. `repeats`: timings of each point. `peers`: solvers of other
    libraries beside them, where they are installed. `verify.plot_work_precision` draws it. Raises
    InputError, one line.
    """
    sizes = listed("step_sizes", step_sizes)
    if len(sizes) < 2:
        raise InputError("step_sizes", step_sizes, "is one; an order takes two at least")
    section = {
        "time": time,
        "step_sizes": sizes,
        "initial_value": {"q": q, "p": p},
        "repeats": repeats,
        "peers": None if peers else False,
    }
    scene = scene_of(system, scheme, parameters, t0=t0, work_precision=section)
    task = work_precision_task(scene)
    points = len(task.schemes) * len(task.step_sizes)
    with progress_of(progress, "errors", points, adding=True) as tell:
        return task.measure(tell or (lambda _: None))
