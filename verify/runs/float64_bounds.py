"""Error bounds of float64 runs, which include the rounding of their inputs.

Up to `DIRECT_STEPS` steps float64 is compared with a certified run (`verify.runs.digits_on_demand`)
from the exact inputs: the bound is rigorous. Where there is no certificate, and the orbit is short,
it is compared with an mpfr rerun whose precision is itself confirmed, an estimate.

Longer runs are compared with a compensated run (see `verify.kernels.statements`). The bound is four
times the greatest difference at any checkpoint, of all coordinates together, since a single
difference may be small by chance. It leaves out the rounding of h, the parameters and the initial
values. Where errors grow linearly in time, that rounding shifts the phase by about T·2⁻⁵³, and the
rounding of N ≥ 20,000 states by about √N·T·2⁻⁵³/5. Where they grow exponentially, as near a
separatrix, every rounding counts alike, and there are N times as many of the states. If the two
orbits differ by more than their size, no value is given. (`verify separate` has rigorous bounds at
full length, in twenty times the time.)
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import reduce

import flint

from verify import arithmetic as number_systems
from verify import observables
from verify.arithmetic.arb import bounds, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.kernels.rounding import FLOAT64_ROUNDING, PRECISION_BITS, RoundedValue, analyse
from verify.kernels.statements import integrals_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course
from verify.runs.digits_on_demand import Measurement, certify_run, choose
from verify.runs.estimates import LINEAR, BoundedValues, Bounds, resolve, spread, working_digits

DIRECT_STEPS = 200_000
REFERENCE = "mpfr"  # mpmath gives the same and takes five to ten times as long
_CERTIFIED_DIGITS = 20
_REFERENCE_DIGITS = 40
_FOLLOWED_STEPS = 1000  # limit for a chaotic orbit, which loses digits at every step
_RERUN_STEPS = 20_000  # limit for a rerun in mpfr, where there is no certificate


def bound_errors(run: KernelRun, first: RunOutcome, proved_values: BoundedValues) -> Course[Bounds]:
    """Return the values of the float64 run `first` of `run` with their bounds.

    `proved_values`: those that a proof gives for observables that were not run.
    """
    if first.done < run.steps:
        return Bounds({}, "none", "left range", first.done + 1)
    # A compensated run has the same clock, so that the difference would not show its rounding.
    direct = run.steps <= DIRECT_STEPS or run.hamiltonian.time_dependent
    compared = (
        (yield from _compare_with_certified(run, first))
        if direct
        else _compare_with_compensated(run, first)
    )
    values = dict(compared.values)
    better = (proved_values | values).get("lambda")
    if "lambda_plain" in first.values and "lambda_plain" not in values and better:
        # Λ by the closed form is the more accurate value of the same product.
        plain, (closed_value, bound) = first.values["lambda_plain"], better
        values["lambda_plain"] = plain, abs(plain - closed_value) + bound
    return replace(compared, values={n: x for n, x in values.items() if n in first.values})


def _compare_with_certified(run: KernelRun, first: RunOutcome) -> Course[Bounds]:
    """Compare with a certified run; else with an estimated one, or a compensated one."""
    exact_run = run.with_observables(_comparable_observables(run.observables))
    name = choose(exact_run, _CERTIFIED_DIGITS)
    true = yield from certify_run(exact_run, name, _CERTIFIED_DIGITS)
    if isinstance(true, Measurement):
        method = f"difference from a certified run in {name}"
        return Bounds(_distances(first, true.bounds.values), method, rigorous=True)
    if run.steps > _RERUN_STEPS:
        return _compare_with_compensated(run, first)
    # Two runs are compared note by note, so that both must have noted the same steps.
    rerun = run.with_observables(exact_run.observables, run.sections)
    return (yield from _compare_with_rerun(rerun, first))


def _comparable_observables(observables: frozenset[str]) -> frozenset[str]:
    """Return the observables whose true values are needed: Λ in place of the plain product."""
    plain = {"lambda"} if "lambda_plain" in observables else set()
    return (observables - {"lambda_plain", "extremes"}) | plain


def _distances(first: RunOutcome, true: BoundedValues) -> BoundedValues:
    """Return the values with their distances from the true ones; for the plain product from Λ."""
    if "lambda" in true:
        true = {**true, "lambda_plain": true["lambda"]}
    return {n: (x, abs(x - true[n][0]) + true[n][1]) for n, x in first.values.items() if n in true}


def _compare_with_rerun(run: KernelRun, first: RunOutcome) -> Course[Bounds]:
    reference = number_systems.get(REFERENCE, working_digits(_REFERENCE_DIGITS, run.steps))
    second = run.run(reference)
    method = f"rerun in {REFERENCE} with {_REFERENCE_DIGITS} digits"
    # If the two agree to a hundredth, float64's rounding is still small against the orbit, and
    # the rerun's is far smaller.
    if second.done == run.steps and spread(first, second) < LINEAR:
        return Bounds(_distances(first, _add_floor(second.values, run.steps)), method)
    # float64 has lost its digits, so the reference has lost many too: it needs a confirmation.
    if run.steps > _FOLLOWED_STEPS:
        return _compare_with_compensated(run, first)
    true = yield from resolve(run, reference, second, 1)
    if true.status != "finished":
        return Bounds({}, f"{method}, which finds another orbit", "unresolved")
    values = {n: value for n, (value, _) in true.values.items()}
    return Bounds(_distances(first, _add_floor(values, run.steps)), method)


def _compare_with_compensated(run: KernelRun, first: RunOutcome) -> Bounds:
    method = "four times the difference from a compensated run"
    second = run.run(number_systems.get("float64", 17), compensated=True)
    if second.done < run.steps:
        return Bounds({}, f"{method}, which left the range", "unresolved")
    distance = spread(first, second)
    if distance > 1:  # two orbits, not one with errors
        return Bounds({}, f"{method}, which is another orbit", "unresolved")
    distance *= 4
    values = {}
    for name, x in first.values.items():
        # All coordinates share one relative distance, as that of one may be small by chance.
        largest = max(abs(a[name]) for a in (*first.trail, *second.trail))
        if name in first.coordinates:
            difference = distance * largest
        else:
            pairs = zip(first.trail, second.trail, strict=True)
            difference = 4 * max(abs(a[name] - b[name]) for a, b in pairs)
        rounding = _rounding_in_loop(run, first, name)
        if rounding is not None:
            values[name] = x, difference + rounding + _floor(x, run.steps)
    return Bounds(values, method)


def _rounding_in_loop(run: KernelRun, outcome: RunOutcome, name: str) -> Fraction | None:
    """Return a bound of the rounding of a function of the state that float64 evaluates in a loop,
    which both runs share; None if the function may be undefined between the noted states."""
    kernel, observable = outcome.kernel, observables.find(name)
    if kernel is None or observable is None or not observable.integral or observable.at_end:
        return Fraction(0)
    index = kernel.outputs[f"e{integrals_of(run.observables).index(observable.integral)}"]
    with working_precision(PRECISION_BITS):
        zero, unit = flint.arb(0), flint.arb(2) ** -53
        numbers = {n: rational_ball(x) for n, x in run.inputs(kernel, 0).items()}
        inputs = {n: RoundedValue(x, abs(x) * unit) for n, x in numbers.items()}
        for n in kernel.coordinates:
            noted = [rational_ball(x[n]) for x in outcome.trail]
            hull = reduce(flint.arb.union, noted, rational_ball(run.start[n]))
            inputs[n] = RoundedValue(hull, zero)
        if kernel.timed:
            inputs["t"] = RoundedValue(reduce(flint.arb.union, map(rational_ball, run.span)), zero)
        live = kernel.lowering.live([index])
        values = analyse(kernel.lowering.program, live, inputs, FLOAT64_ROUNDING)
        return None if values is None else bounds(values[index].error)[1]


def _add_floor(true: Mapping[str, Fraction], steps: int) -> BoundedValues:
    return {n: (x, _floor(x, steps)) for n, x in true.items()}


def _floor(x: Fraction, steps: int) -> Fraction:
    """Return a bound of what no comparison shows: float64's last bits, and underflow in steps."""
    return abs(x) / 2**51 + Fraction(steps, 2**1060)
