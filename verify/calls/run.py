"""`verify.run`: N steps, each number with its error bound."""

from collections.abc import Sequence

from verify.arithmetic.exact import Exact, whole
from verify.arithmetic.systems import float64
from verify.calls.inputs import (
    ParametersLike,
    SchemeLike,
    SystemLike,
    hamiltonian_from,
    is_list,
    scheme_name,
)
from verify.calls.progress import Progress, progress_of
from verify.calls.run_result import RunResult
from verify.errors import InputError
from verify.hamiltonians.start import Given, check_start
from verify.lockstep import Course, run_alone
from verify.runs.run import RequestedRun
from verify.scenes.results.orbit import MOST_POINTS
from verify.scenes.values import AUTO, steps_from

_DIGITS = 17


def run(
    system: SystemLike,
    scheme: SchemeLike,
    *,
    q: Given,
    p: Given,
    step_size: Exact,
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    parameters: ParametersLike = None,
    arithmetic: str | None = None,
    digits: int | None = None,
    observables: Sequence[str] | None = None,
    points: int = 0,
    progress: Progress = None,
) -> RunResult:
    """Run a scheme from (q, p), and give p, q and the observables, each with its error bound.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, or a formula such as "p**2/2 - cos(q)".
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    q, p, step_size: exact numbers; a float is the decimal that it prints as, 0.1 is 1/10. In n
        degrees of freedom q and p are lists.
    steps, time: one of the two; N = ⌊time / step_size⌋ steps.
    t0: the time at the start, for an H that depends on t.
    parameters: exact values by name, beside those that the Hamiltonian has.
    arithmetic: float64, fixed, mpfr, mpmath, ball, or auto, the fastest that certifies the digits.
        Left out: float64, or auto where `digits` is given.
    digits: the requested significant digits; float64 gives those that it can certify.
    observables: of delta_j_max, mse, lambda, lambda_plain, lambda_max, and energy_error_max, the
        greatest |H − H₀|; in n degrees of freedom also symplectic_defect_max, the greatest |entry|
        of any S = JᵀΩJ − Ω, and symplectic_defect, that of all steps together. Left out: those that
        the command tells.
    points: so many states, at most, in `orbit` and in `series`, 1 … 10,000; 0 leaves `series` out.
    progress: None for a bar in a notebook, True for one anywhere, False, or a function that is
        called with the number of steps done.

    Returns
    -------
    A RunResult: `values` by name, each a number with its `bound`; `orbit`, the states as arrays
    `t`, `p`, `q`, `energy_error`, `delta_j`, `lambda_`, all without units, made when it is looked
    at.

    Raises InputError, one line, for a bad argument: h ≤ 0, N < 1, a parameter without a value, ….

    >>> result = run("duffing", "lie2", parameters={"delta": 1}, q=1.5, p=0, step_size=0.01,
    ...              steps=9)
    >>> result.values["lambda"] < 0, result.orbit.t.tolist()[:3], result.orbit.texts("p")[1]
    (True, [0.0, 0.01, 0.02], '-0.04875')
    """
    return run_alone(
        run_in_turn(
            system, scheme, q=q, p=p, step_size=step_size, steps=steps, time=time, t0=t0,
            parameters=parameters, arithmetic=arithmetic, digits=digits, observables=observables,
            points=points, progress=progress,
        )
    )  # fmt: skip


def run_in_turn(
    system: SystemLike, scheme: SchemeLike, *, q: Given, p: Given, step_size: Exact,
    steps: int | None, time: Exact | None, t0: Exact = 0, parameters: ParametersLike,
    arithmetic: str | None = None, digits: int | None = None, observables: Sequence[str] | None,
    points: int = 0, progress: Progress,
) -> Course[RunResult]:  # fmt: skip
    """Return the run as a course, which can be stepped together with others."""
    exact = hamiltonian_from(system, parameters)
    check_start(exact, q, p, t0)
    name = scheme_name(scheme, exact)
    count = steps_from(steps, time, step_size)
    whole("points", points, 0, MOST_POINTS)
    digits = None if digits is None else whole("digits", digits, 1)
    # Requested digits need an arithmetic that can certify them; else float64 is the fastest.
    arithmetic = arithmetic or (float64.NAME if digits is None else AUTO)
    if not isinstance(arithmetic, str):
        raise InputError("arithmetic", arithmetic, "is no name of a number system")
    with progress_of(progress, f"{name[:30]}, steps", count) as report:
        request = RequestedRun(
            exact, name, q=q, p=p, step_size=step_size, steps=count, t0=t0, arithmetic=arithmetic,
            digits=digits or _DIGITS, observables=_observable_names(observables),
            points=int(points),
        )  # fmt: skip
        result = yield from request.result(report)
    return RunResult.from_result(result).with_points(int(points))


def _observable_names(observables: Sequence[str] | None) -> tuple[str, ...] | None:
    if observables is None:
        return None
    return tuple(observables) if is_list(observables) else (str(observables),)
