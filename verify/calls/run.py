"""`verify.run` and `verify.sweep`: a run of N steps, with a bound on each number; and many runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

from verify.arithmetic.exact import Number, NumberOrList, positive, rational, text, whole
from verify.arithmetic.systems import float64
from verify.calls import inputs
from verify.calls.progress import Progress, progress_of
from verify.calls.run_result import RunResult
from verify.errors import InputError
from verify.execution.plan import MOST_AT_ONCE
from verify.hamiltonians.run_domain import check_point, start_of
from verify.lockstep import Course, run_alone, run_together
from verify.runs.requested_run import RequestedRun
from verify.scenes.measured_structures import measured_structures
from verify.scenes.observables import CLOSED_FORM, observables_aside, select_observables
from verify.scenes.results.run import MOST_POINTS
from verify.scenes.results.sweep import Sweep
from verify.scenes.values import AUTO, steps_from
from verify.structures.reading import KeepsRequest

_DEFAULT_DIGITS = 17
_MAX_RUNS = 100_000  # the limit for a sweep


def run(
    system: inputs.SystemLike,
    scheme: inputs.SchemeLike,
    *,
    q: NumberOrList | None = None,
    p: NumberOrList | None = None,
    start: Mapping[str, Number] | None = None,
    step_size: Number,
    steps: int | None = None,
    time: Number | None = None,
    t0: Number = 0,
    parameters: inputs.ParametersLike = None,
    arithmetic: str | None = None,
    digits: int | None = None,
    observables: Sequence[str] | None = None,
    keeps: inputs.Texts = (),
    form: str = "",
    density: str = "",
    poisson: str = "",
    casimirs: inputs.Texts = (),
    reverses: str = "",
    factor: str = "",
    points: int = 0,
    progress: Progress = None,
) -> RunResult:
    """Run a scheme from (q, p), and return p, q and the observables, each with its error bound.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, a formula such as "p**2/2 - cos(q)", or equations
        without an H, as "u_dot = u*(v - 2); v_dot = v*(1 - u)".
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    q, p, step_size: exact numbers; a float is the decimal that it prints as, 0.1 is 1/10. In n
        degrees of freedom q and p are lists of n numbers. All numbers are without units.
    start: of equations, the initial values by name in place of q and p, as {"u": 1, "v": 2}.
    steps, time: one of the two; N = ⌊time / step_size⌋ steps.
    t0: the time at the start, for an H that depends on t.
    parameters: exact values by name, in addition to those that the Hamiltonian has.
    arithmetic: float64, fixed, mpfr, mpmath, ball, or auto, the fastest that certifies the digits.
        By default float64, or auto if `digits` is given.
    digits: the requested significant digits; float64 gives those that it can certify.
    observables: names among delta_j_max, mse, lambda, lambda_plain, lambda_max, energy_error,
        which is H − H₀ at the end, and energy_error_max, the greatest |H − H₀|; in n degrees of
        freedom also symplectic_defect_max, the greatest |entry| of S = JᵀΩJ − Ω in any step, and
        symplectic_defect, that of W, the defect of all steps together. By default delta_j_max, mse
        and lambda, in n degrees of freedom both symplectic defects, and for an H without t both
        energy errors, with the digits that they have then.
    keeps: what is measured of what the step is meant to keep, a text or several: area, symplectic,
        volume, energy, momentum, angular-momentum, reversible, symmetric, conformal, poisson, or
        the formula of a first integral. Nothing is judged; see `keeps` of the result.
    form, density, poisson, casimirs, reverses, factor: what refines a structure, as in `prove`.
    points: the limit on the states in `orbit` and in `series`, 1 … 10,000; 0 leaves `series` out.
    progress: None for a bar in a notebook, True for one anywhere, False, or a function that is
        called with the number of steps done.

    Returns
    -------
    A RunResult: `values` by name, each a number with its `bound`; `orbit`, the states as arrays
    `t`, `p`, `q`, `energy_error`, `delta_j`, `lambda_`, all without units, computed at its first
    use.

    Raises InputError, one line, for a bad argument: h ≤ 0, N < 1, a parameter without a value, ….

    >>> result = run("duffing", "lie2", parameters={"delta": 1}, q=1.5, p=0, step_size=0.01,
    ...              steps=9)
    >>> result.values["lambda"] < 0, result.orbit.t.tolist()[:3], result.orbit.texts("p")[1]
    (True, [0.0, 0.01, 0.02], '-0.04875')
    """
    return run_alone(
        run_in_turn(
            system, scheme, q=q, p=p, start=start, step_size=step_size, steps=steps, time=time,
            t0=t0, parameters=parameters, arithmetic=arithmetic, digits=digits,
            observables=observables, points=points, progress=progress,
            keeps=inputs.keeps_request(
                keeps, form, density, poisson, casimirs, reverses, factor
            ),
        )
    )  # fmt: skip


def run_in_turn(
    system: inputs.SystemLike, scheme: inputs.SchemeLike, *, q: NumberOrList | None,
    p: NumberOrList | None, step_size: Number, start: Mapping[str, Number] | None = None,
    steps: int | None, time: Number | None, t0: Number = 0, parameters: inputs.ParametersLike,
    arithmetic: str | None = None, digits: int | None = None, observables: Sequence[str] | None,
    keeps: KeepsRequest | None = None, points: int = 0, progress: Progress,
) -> Course[RunResult]:  # fmt: skip
    """Do `run` as a course, a generator that can be stepped together with others."""
    hamiltonian = inputs.hamiltonian_from(system, parameters, takes_field=True)
    check_point(hamiltonian, start_of(hamiltonian, q, p, start), t0)
    name = inputs.scheme_name(scheme, hamiltonian)
    count = steps_from(steps, time, step_size)
    whole("points", points, 0, MOST_POINTS)
    digits = None if digits is None else whole("digits", digits, 1)
    # Requested digits need a number system that can certify them; without them float64 is fastest.
    arithmetic = arithmetic or (float64.NAME if digits is None else AUTO)
    if not isinstance(arithmetic, str):
        raise InputError("arithmetic", arithmetic, "is no name of a number system")
    measured = measured_structures(hamiltonian, keeps) if keeps else ()
    requested = select_observables(hamiltonian, _observable_names(observables))
    requested += tuple(x for structure in measured for x in structure.observables)
    with progress_of(progress, f"{name[:30]}, steps", count) as report:
        request = RequestedRun(
            hamiltonian, name, q=q, p=p, start=start, step_size=step_size, steps=count, t0=t0,
            arithmetic=arithmetic, digits=digits or _DEFAULT_DIGITS,
            observables=tuple(dict.fromkeys(requested)), points=int(points),
            aside=observables_aside(hamiltonian) if observables is None else (),
        )  # fmt: skip
        result = yield from request.result(report)
    return RunResult.from_result(result).with_points(int(points)).with_measured(measured)


def _observable_names(observables: Sequence[str] | None) -> tuple[str, ...] | None:
    if observables is None:
        return None
    return tuple(observables) if inputs.is_list(observables) else (str(observables),)


def sweep(
    system: inputs.SystemLike,
    scheme: inputs.SchemesLike,
    *,
    q: inputs.NumbersLike,
    p: inputs.NumbersLike,
    step_size: inputs.NumbersLike,
    steps: int | None = None,
    time: Number | None = None,
    parameters: Mapping[str, inputs.NumbersLike] | None = None,
    observables: Sequence[str] = CLOSED_FORM,
    progress: Progress = None,
    **options: Any,
) -> Sweep:
    """Run every combination of the arguments that are lists, and return a table of the values.

    The arguments are those of `verify.run`, in one degree of freedom.

    Parameters
    ----------
    scheme, step_size, q, p, parameters: one value, of each of the parameters too, or a list, a
        range or an array with one axis; all combinations are run, 100,000 at most.
    steps, time: one of the two; with `time` a step size h has N = ⌊time / h⌋ steps.
    observables: as in `verify.run`; by default delta_j_max, mse and lambda.
    progress: as in `verify.run`; it counts runs.
    options: `arithmetic`, `digits` and `t0` of `verify.run`.

    Returns a Sweep with a row for each run; from row to row the last axis varies fastest. It has
    `rows` as exact texts, `column` as an array of float64, `to_dataframe` and `to_xarray`. A run
    that left its range has empty values, and its `status` says so. Raises InputError, one line, as
    `verify.run` does.

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
    # The first value of each parameter serves to parse H once; each run substitutes its own values.
    hamiltonian = inputs.hamiltonian_from(system, {name: x[0] for name, x in values.items()})
    axes: dict[str, list[Any]] = {
        "scheme": inputs.schemes_from(scheme, hamiltonian),
        "step_size": [positive(x, "step_size") for x in inputs.as_list("step_size", step_size)],
        "q": [rational(x, "q") for x in inputs.as_list("q", q)],
        "p": [rational(x, "p") for x in inputs.as_list("p", p)],
        **values,
    }
    combinations = list(product(*axes.values()))
    if len(combinations) > _MAX_RUNS:
        raise InputError("sweep", len(combinations), f"are more than {_MAX_RUNS} runs")

    def start_run(point: Sequence[Any]) -> Course[RunResult]:
        arguments = dict(zip(axes, point, strict=True))
        parameter_values = {name: arguments.pop(name) for name in values}
        return run_in_turn(hamiltonian, parameters=parameter_values, steps=steps, time=time,
                           observables=observables, progress=False, **options,
                           **arguments)  # fmt: skip

    runs: dict[int, RunResult] = {}
    with progress_of(progress, "runs", len(combinations)) as report:
        # Runs of one kernel are stepped together, in the lanes of the vector unit. They end in any
        # order, so the results are sorted by their numbers below.
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
        name: [
            rational(x, f"parameter {name}") for x in inputs.as_list(f"parameter {name}", values)
        ]
        for name, values in (parameters or {}).items()
    }


def _format_value(x: Any) -> str:
    return x if isinstance(x, str) else text(x)
