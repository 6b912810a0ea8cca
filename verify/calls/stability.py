"""`verify.stability`: verdicts on runs, stable or not, and for which reason."""

from typing import Any

from verify.arithmetic.exact import Exact
from verify.calls.inputs import ParametersLike, SystemLike, as_list, perform, scene_of
from verify.hamiltonians.start import Given
from verify.scenes.results.stability import StabilityResult
from verify.studies.kinds.stability import findings_of, need_stability


def stability(
    system: SystemLike,
    scheme: Any,
    *,
    q: Given,
    p: Given,
    step_size: Any,
    steps: int | None = None,
    time: Exact | None = None,
    parameters: ParametersLike = None,
    t0: Exact | None = None,
    workers: int = 1,
) -> tuple[StabilityResult, ...]:
    """Judge runs: stable, drifts, unstable by the scheme or by arithmetic, escapes, overflow, ….

    The arguments are those of `verify.run`; `scheme` and `step_size` may be lists; `workers` are
    processes, as in `verify.flow`. Returns one result a scheme and step size, with its `verdict`
    and `detail`. Raises InputError, one line.

    >>> found = stability("harmonic", ["euler", "stormer-verlet"], parameters={"omega": 1},
    ...                   q=1, p=0, step_size=0.1, time=100)
    >>> [(run.scheme, run.kind) for run in found]
    [('euler', 'unstable: scheme'), ('stormer-verlet', 'stable')]
    """
    section = {
        "step_sizes": as_list("step_size", step_size),
        "initial_values": [{"q": q, "p": p}],
        "steps": steps,
        "time": time,
    }
    scene = scene_of(system, scheme, parameters, t0=t0, stability=[section])
    return findings_of([scene], perform(scene, need_stability, workers)).stability
