"""`verify.bench`: error against run time."""

from typing import Any

from verify.arithmetic.exact import Exact
from verify.calls.inputs import ParametersLike, SystemLike, as_list, scene_of
from verify.calls.progress import Progress, progress_of
from verify.errors import InputError
from verify.hamiltonians.start import Given
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.kinds.work_precision import work_precision_task


def bench(
    system: SystemLike,
    scheme: Any,
    *,
    q: Given,
    p: Given,
    step_sizes: Any,
    time: Exact,
    t0: Exact = 0,
    parameters: ParametersLike = None,
    repeats: int = 5,
    peers: bool = False,
    progress: Progress = None,
) -> WorkPrecisionResult:
    """Measure the work–precision of schemes: error at `time` against run time in seconds.

    The arguments are those of `verify.run`; `scheme` may be a list. `step_sizes`: two at least;
    N is time/h, rounded down. `repeats`: timings of each point. `peers`: also solvers of other
    installed libraries. Returns the errors of the solution and of area (Λ), which
    `verify.plot_work_precision` draws. Raises InputError, one line.
    """
    sizes = as_list("step_sizes", step_sizes)
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
    # One unit of the bar is the error of one point.
    with progress_of(progress, "errors", points, adding=True) as report:
        return task.measure(report or (lambda _: None))
