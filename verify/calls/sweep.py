"""`verify.sweep`: runs for all combinations of lists of arguments, as one table."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

from verify.arithmetic.exact import Exact, positive, rational, text
from verify.calls.inputs import SystemLike, as_list, hamiltonian_from, schemes_from
from verify.calls.progress import Progress, progress_of
from verify.calls.run import run_in_turn
from verify.errors import InputError
from verify.execution.ensembles import MOST_AT_ONCE
from verify.lockstep import Course, run_together
from verify.scenes.observables import CLOSED_FORM
from verify.scenes.results.run import RunResult
from verify.scenes.results.sweep import Sweep

_MOST = 100_000  # runs


def sweep(
    system: SystemLike,
    scheme: Any,
    *,
    q: Any,
    p: Any,
    step_size: Any,
    steps: int | None = None,
    time: Exact | None = None,
    parameters: Mapping[str, Any] | None = None,
    observables: Sequence[str] = CLOSED_FORM,
    progress: Progress = None,
    **options: Any,
) -> Sweep:
    """Run every combination of the arguments that are lists, and return a table of the values.

    The arguments are those of `verify.run`. `scheme`, `step_size`, `q`, `p` and each of the
    `parameters` may be lists, ranges or arrays; `time` gives every step size its N = ⌊time / h⌋.
    `options`: `arithmetic`, `digits`, `t0`. Raises InputError, one line, as `verify.run`; a run
    that left its range has empty values, and its `status` says so.

    >>> table = sweep("duffing", ["lie2", "rk4"], parameters={"delta": 1}, q=1.5, p=0,
    ...               step_size=[0.1, 0.05], time=1)
    >>> table
    Sweep(4 runs: 2 scheme × 2 step_size × 1 q × 1 p × 1 delta; delta_j_max, mse, lambda)
    >>> table.column("lambda").shape, table.column("step_size").tolist()
    ((4,), [0.1, 0.05, 0.1, 0.05])
    """
    option_names = {"arithmetic", "digits", "t0"}
    for name in set(options) - option_names:
        raise InputError(
            name, options[name], f"unknown; allowed: {', '.join(sorted(option_names))}"
        )
    values = _list_parameters(parameters)
    # One value of each parameter is enough to parse H once; each run puts in its own values.
    exact = hamiltonian_from(system, {name: x[0] for name, x in values.items()})
    axes: dict[str, list[Any]] = {
        "scheme": schemes_from(scheme, exact),
        "step_size": [positive(x, "step_size") for x in as_list("step_size", step_size)],
        "q": [rational(x, "q") for x in as_list("q", q)],
        "p": [rational(x, "p") for x in as_list("p", p)],
        **values,
    }
    combinations = list(product(*axes.values()))
    if len(combinations) > _MOST:
        raise InputError("sweep", len(combinations), f"are more than {_MOST} runs")

    def start_run(point: Sequence[Any]) -> Course[RunResult]:
        arguments = dict(zip(axes, point, strict=True))
        parameter_values = {name: arguments.pop(name) for name in values}
        return run_in_turn(exact, parameters=parameter_values, steps=steps, time=time,
                           observables=observables, progress=False, **options,
                           **arguments)  # fmt: skip

    runs: dict[int, RunResult] = {}
    with progress_of(progress, "runs", len(combinations)) as report:
        # Runs of one kernel wait for each other and are stepped in the lanes of the vector unit;
        # they end in any order, so the results are sorted by number below.
        for number, outcome in run_together(map(start_run, combinations), MOST_AT_ONCE):
            runs[number] = outcome.result()
            if report:
                report(len(runs))
    columns = {name: tuple(map(_format_value, axis)) for name, axis in axes.items()}
    return Sweep(columns, tuple(runs[k] for k in sorted(runs)), tuple(observables))


def _list_parameters(parameters: Mapping[str, Any] | None) -> dict[str, list[Any]]:
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InputError("parameters", parameters, "is not a mapping of names to values")
    clashes = {"scheme", "step_size", "q", "p"} & set(parameters or {})
    if clashes:
        raise InputError("parameter", min(clashes), "is no parameter's name")
    return {
        name: [rational(x, f"parameter {name}") for x in as_list(f"parameter {name}", values)]
        for name, values in (parameters or {}).items()
    }


def _format_value(x: Any) -> str:
    return x if isinstance(x, str) else text(x)
