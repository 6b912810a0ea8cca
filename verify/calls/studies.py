"""`verify.flow`, `verify.stability` and `verify.bench`: studies of several schemes side by side.

The arguments of a call become a section of a scene, which is read as if from a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from verify.arithmetic.exact import Number, NumberOrList
from verify.calls import inputs
from verify.calls.progress import Progress, progress_of
from verify.errors import InputError
from verify.scenes.results.regions import FlowResult
from verify.scenes.results.stability import StabilityResult
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.kinds.regions import flows_of, need_flows
from verify.studies.kinds.stability import findings_of, need_stability
from verify.studies.kinds.work_precision import work_precision_task

_ORIGIN = (0, 0)


def flow(
    system: inputs.SystemLike,
    scheme: inputs.SchemesLike,
    *,
    step_size: Number,
    steps: int | Iterable[int] | None = None,
    times: inputs.NumbersLike | None = None,
    t0: Number = 0,
    parameters: inputs.ParametersLike = None,
    shape: str | None = None,
    polygon: Sequence[tuple[Number, Number]] | None = None,
    path: str | None = None,
    centre: tuple[NumberOrList, NumberOrList] = _ORIGIN,
    plane: int = 1,
    scale: Number = 1,
    exact: bool = True,
    mean_lambda: bool = True,
    digits: int = 17,
    workers: int = 1,
) -> FlowResult:
    """Carry a region by one scheme or several, and measure the change of its area.

    Parameters
    ----------
    system, scheme, step_size, parameters: as in `verify.run`; `scheme` may be a list.
    steps, times: one of the two, a number or a list; for a time T, N = ⌊T/h⌋.
    t0: the time at the start, for an H that depends on t.
    shape: a name, circle, square or cat; or `polygon`, its corners (q, p) in their order; or
        `path`, as in SVG, where x is q and y is p. Without any of them a circle.
    centre: the (q, p) of the shape's centre; `scale`: the factor of its size. In n degrees of
        freedom q and p are lists, the region lies in the plane (q_i, p_i) with i = `plane`, and
        ∮ p·dq is measured.
    exact: True carries the region by the exact flow too, and measures the distance from its image.
    mean_lambda: True computes the mean of Λ over the region, for schemes that change area.
    digits: the requested significant digits of areas and distances.
    workers: the number of processes; 1 means this process. Further ones import the caller's script
        again, so that the call must stand under `if __name__ == "__main__"`.

    Returns a FlowResult: `before`, the outlines of the shape, and `images`, one for each map and
    number of steps, with `area_change`, `mean_lambda`, `distance` and their errors. Raises
    InputError, one line.

    >>> result = flow("harmonic", "stormer-verlet", parameters={"omega": 1}, step_size=0.1, steps=3)
    >>> [(image.map, image.area_preserving) for image in result.images]
    [('exact flow', True), ('stormer-verlet', True)]
    """
    if not isinstance(centre, Sequence) or isinstance(centre, str) or len(centre) != 2:
        raise InputError("centre", centre, "is no pair (q, p)")
    if shape is None and polygon is None and path is None:
        shape = "circle"
    section = {
        "shape": shape,
        "polygon": polygon,
        "path": path,
        # The default is left out, as in n degrees of freedom two zeros are too few. It is compared
        # by identity, so that a (0, 0) from the caller is checked.
        **({} if centre is _ORIGIN else {"centre": {"q": centre[0], "p": centre[1]}}),
        "plane": plane,
        "scale": scale,
        "step_size": step_size,
        "steps": None if steps is None else inputs.as_list("steps", steps),
        "times": None if times is None else inputs.as_list("times", times),
        "exact": exact,
        "mean_lambda": mean_lambda,
        "digits": digits,
    }
    scene = inputs.scene_of(system, scheme, parameters, t0=t0, flow=[section])
    return flows_of(scene, inputs.perform(scene, need_flows, workers))[0]


def stability(
    system: inputs.SystemLike,
    scheme: inputs.SchemesLike,
    *,
    q: NumberOrList,
    p: NumberOrList,
    step_size: inputs.NumbersLike,
    steps: int | None = None,
    time: Number | None = None,
    parameters: inputs.ParametersLike = None,
    t0: Number | None = None,
    workers: int = 1,
) -> tuple[StabilityResult, ...]:
    """Judge runs: stable, drifts, unstable by the scheme or by arithmetic, escapes, overflow, ….

    Parameters
    ----------
    system, q, p, steps, time, t0, parameters: as in `verify.run`.
    scheme, step_size: as in `verify.run`, one or a list of each.
    workers: processes, as in `verify.flow`.

    Returns a StabilityResult for each scheme and step size: its `kind`, its `verdict` in words, and
    `detail`, the cause. Raises InputError, one line.

    >>> results = stability("harmonic", ["euler", "stormer-verlet"], parameters={"omega": 1},
    ...                     q=1, p=0, step_size=0.1, time=100)
    >>> [(run.scheme, run.kind) for run in results]
    [('euler', 'unstable: scheme'), ('stormer-verlet', 'stable')]
    """
    section = {
        "step_sizes": inputs.as_list("step_size", step_size),
        "initial_values": [{"q": q, "p": p}],
        "steps": steps,
        "time": time,
    }
    scene = inputs.scene_of(system, scheme, parameters, t0=t0, stability=[section])
    return findings_of([scene], inputs.perform(scene, need_stability, workers)).stability


def bench(
    system: inputs.SystemLike,
    scheme: inputs.SchemesLike,
    *,
    q: NumberOrList,
    p: NumberOrList,
    step_sizes: inputs.NumbersLike,
    time: Number,
    t0: Number = 0,
    parameters: inputs.ParametersLike = None,
    repeats: int = 5,
    peers: bool = False,
    progress: Progress = None,
) -> WorkPrecisionResult:
    """Measure the work–precision of schemes: error at `time` against run time in seconds.

    Parameters
    ----------
    system, q, p, t0, parameters: as in `verify.run`.
    scheme: one, or a list.
    step_sizes: two at least; each h has N = ⌊time / h⌋ steps.
    time: the end T of the runs; errors are those at t = N·h.
    repeats: the number of timings of each point; results have their least and their median.
    peers: True measures solvers of other installed libraries too.
    progress: as in `verify.run`; it counts points.

    Returns a WorkPrecisionResult: `lines`, one for each scheme or peer. Its `points` have the
    `error` of the solution, |z_N − z(N·h)| in (p, q), the area error Λ, or max |W_N| in n degrees
    of freedom, and the run times. `verify.plot_work_precision` draws it. Raises InputError, one
    line.
    """
    sizes = inputs.as_list("step_sizes", step_sizes)
    if len(sizes) < 2:
        raise InputError("step_sizes", step_sizes, "is one; an order takes two at least")
    section = {
        "time": time,
        "step_sizes": sizes,
        "initial_value": {"q": q, "p": p},
        "repeats": repeats,
        "peers": None if peers else False,
    }
    scene = inputs.scene_of(system, scheme, parameters, t0=t0, work_precision=section)
    task = work_precision_task(scene)
    points = len(task.schemes) * len(task.step_sizes)
    # One unit of the bar is the error of one point.
    with progress_of(progress, "errors", points, adding=True) as report:
        return task.measure(report or (lambda _: None))
