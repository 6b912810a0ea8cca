"""`verify.sweep`: runs over a product of whatever is given as a list, as one table."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

from verify.arithmetic.exact import Exact, positive, rational, text
from verify.calls.given import GivenSystem, hamiltonian_from, listed, schemes_from
from verify.calls.progress import Progress, progress_of
from verify.calls.run import run_in_turn
from verify.errors import InputError
from verify.execution.ensembles import MOST_AT_ONCE
from verify.lockstep import Course, together
from verify.scenes.observables import CLOSED_FORM
from verify.scenes.results.run import RunResult
from verify.scenes.results.sweep import Sweep

_MOST = 100_000  # runs


def sweep(
    system: GivenSystem,
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
    """Runs for every combination of what is given as a list: a table of their values.

    The arguments are those of `verify.run`. `scheme`, `step_size`, `q`, `p` and each of the
    `parameters` may be lists, ranges or arrays; `time` gives every step size its N = ⌊time / h⌋.
    `options`: `arithmetic`, `digits`, `t0`. Raises InputError, one line, as `verify.run`; a run
    that left its range has empty values, and its `status` says so.

    >>> found = sweep("duffing", ["lie2", "rk4"], parameters={"delta": 1}, q=1.5, p=0,
    ...               step_size=[0.1, 0.05], time=1)
    >>> found
    Sweep(4 runs: 2 scheme × 2 step_size × 1 q × 1 p × 1 delta; delta_j_max, mse, lambda)
    >>> found.column("lambda").shape, found.column("step_size").tolist()
    ((4,), [0.1, 0.05, 0.1, 0.05])
    """
    known = {"arithmetic", "digits", "t0"}
    for name in set(options) - known:
        raise InputError(name, options[name], f"unknown; allowed: {', '.join(sorted(known))}")
    values = _parameters(parameters)
    exact = hamiltonian_from(system, {name: x[0] for name, x in values.items()})
    axes: dict[str, list[Any]] = {
        "scheme": schemes_from(scheme, exact),
        "step_size": [positive(x, "step_size") for x in listed("step_size", step_size)],
        "q": [rational(x, "q") for x in listed("q", q)],
        "p": [rational(x, "p") for x in listed("p", p)],
        **values,
    }
    combinations = list(product(*axes.values()))
    if len(combinations) > _MOST:
        raise InputError("sweep", len(combinations), f"are more than {_MOST} runs")

    def one(at: Sequence[Any]) -> Course[RunResult]:
        chosen = dict(zip(axes, at, strict=True))
        own = {name: chosen.pop(name) for name in values}
        return run_in_turn(exact, parameters=own, steps=steps, time=time, observables=observables,
                           progress=False, **options, **chosen)  # fmt: skip

    runs: dict[int, RunResult] = {}
    with progress_of(progress, "runs", len(combinations)) as tell:
        for number, ended in together(map(one, combinations), MOST_AT_ONCE):
            runs[number] = ended.result()
            if tell:
                tell(len(runs))
    shown = {name: tuple(map(_text, given)) for name, given in axes.items()}
    return Sweep(shown, tuple(runs[k] for k in sorted(runs)), tuple(observables))


def _parameters(given: Mapping[str, Any] | None) -> dict[str, list[Any]]:
    if given is not None and not isinstance(given, Mapping):
        raise InputError("parameters", given, "is not a mapping of names to values")
    taken = {"scheme", "step_size", "q", "p"} & set(given or {})
    if taken:
        raise InputError("parameter", min(taken), "is no parameter's name")
    return {
        name: [rational(x, f"parameter {name}") for x in listed(f"parameter {name}", values)]
        for name, values in (given or {}).items()
    }


def _text(x: Any) -> str:
    return x if isinstance(x, str) else text(x)
