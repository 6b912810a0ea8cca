"""Error bounds of float64 runs: what rounding left of the digits, that of the inputs included.

Up to `DIRECT_STEPS` steps float64 is held against a certified run (`verify.runs.digits_on_demand`)
from the exact inputs: the bound is rigorous. Where there is no certificate, and the orbit is short,
it is held against an mpfr rerun whose precision is itself confirmed, an estimate.

Beyond: against a compensated run (see `verify.kernels.statements`), by four times the greatest
difference at any of the checkpoints on the way, p and q taken together, since a single difference
may be small by chance. That leaves the rounding of h, the parameters and the initial values aside.
Where errors grow linearly in time it shifts the phase by about T·2⁻⁵³, while the rounding of N ≥
20,000 states shifts it by about √N·T·2⁻⁵³/5; where they grow exponentially, as near a separatrix,
every rounding counts alike, and the states' are N to one. Where the two orbits differ by more than
their size no value is given. (`verify separate` has rigorous bounds at full length, at twenty times
the price.)
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course
from verify.runs.digits_on_demand import Measured, certified, choose
from verify.runs.estimated import LINEAR, Bounded, Bounds, resolved, spread, working_digits

DIRECT_STEPS = 200_000
REFERENCE = "mpfr"  # mpmath finds the same, and takes five to ten times as long
_CERTIFIED_DIGITS = 20
_REFERENCE_DIGITS = 40
_FOLLOWED_STEPS = 1000  # a chaotic orbit is followed so far; it loses digits at every step
_RERUN_STEPS = 20_000  # an orbit is followed in mpfr so far where there is no certificate


def bounded(run: KernelRun, first: Outcome, known: Bounded) -> Course[Bounds]:
    """The values of the float64 run `first` of the run with their bounds.

    `known`: what a proof gives for observables that were not run.
    """
    if first.done < run.steps:
        return Bounds({}, "none", "left range", first.done + 1)
    # A compensated run has the same clock, whose rounding it would not see.
    direct = run.steps <= DIRECT_STEPS or run.hamiltonian.time_dependent
    found = (yield from _held(run, first)) if direct else _compensated(run, first)
    values = dict(found.values)
    better = (known | values).get("lambda")
    if "lambda_plain" in first.values and "lambda_plain" not in values and better:
        # The closed form is the better value of the same product, up to its own error.
        plain, (closed, bound) = first.values["lambda_plain"], better
        values["lambda_plain"] = plain, abs(plain - closed) + bound
    return replace(found, values={n: x for n, x in values.items() if n in first.values})


def _held(run: KernelRun, first: Outcome) -> Course[Bounds]:
    """Against a certified run; else against an estimated one, or a compensated one."""
    exact = run.observing(_comparable(run.observables))
    name = choose(exact, _CERTIFIED_DIGITS)
    true = yield from certified(exact, name, _CERTIFIED_DIGITS)
    if isinstance(true, Measured):
        method = f"difference from a certified run in {name}"
        return Bounds(_from(first, true.bounds.values), method, rigorous=True)
    if run.steps > _RERUN_STEPS:
        return _compensated(run, first)
    return (yield from _against_rerun(exact, first))


def _comparable(observables: frozenset[str]) -> frozenset[str]:
    """What the true values are wanted of: the plain product's is Λ."""
    plain = {"lambda"} if "lambda_plain" in observables else set()
    return (observables - {"lambda_plain", "extremes"}) | plain


def _from(first: Outcome, true: Bounded) -> Bounded:
    """The values with their distance from the true ones; the plain product's true value is Λ."""
    if "lambda" in true:
        true = {**true, "lambda_plain": true["lambda"]}
    return {n: (x, abs(x - true[n][0]) + true[n][1]) for n, x in first.values.items() if n in true}


def _against_rerun(run: KernelRun, first: Outcome) -> Course[Bounds]:
    reference = number_systems.get(REFERENCE, working_digits(_REFERENCE_DIGITS, run.steps))
    second = run.run(reference)
    method = f"rerun in {REFERENCE} with {_REFERENCE_DIGITS} digits"
    if second.done == run.steps and spread(first, second) < LINEAR:
        return Bounds(_from(first, _floored(second.values, run.steps)), method)
    # float64 has lost every digit, so the reference has lost many: is it good for the rest?
    if run.steps > _FOLLOWED_STEPS:
        return _compensated(run, first)
    true = yield from resolved(run, reference, second, 1)
    if true.status != "finished":
        return Bounds({}, f"{method}, which finds another orbit", "unresolved")
    values = {n: value for n, (value, _) in true.values.items()}
    return Bounds(_from(first, _floored(values, run.steps)), method)


def _compensated(run: KernelRun, first: Outcome) -> Bounds:
    method = "four times the difference from a compensated run"
    second = run.run(number_systems.get("float64", 17), compensated=True)
    if second.done < run.steps:
        return Bounds({}, f"{method}, which left the range", "unresolved")
    apart = spread(first, second)
    if apart > 1:  # two orbits, not one with errors
        return Bounds({}, f"{method}, which is another orbit", "unresolved")
    apart *= 4
    found = {}
    for name, x in first.values.items():
        largest = max(abs(a[name]) for a in (*first.trail, *second.trail))
        if name in first.coordinates:
            difference = apart * largest
        else:
            pairs = zip(first.trail, second.trail, strict=True)
            difference = 4 * max(abs(a[name] - b[name]) for a, b in pairs)
        found[name] = x, difference + _floor(x, run.steps)
    return Bounds(found, method)


def _floored(true: Mapping[str, Fraction], steps: int) -> Bounded:
    return {n: (x, _floor(x, steps)) for n, x in true.items()}


def _floor(x: Fraction, steps: int) -> Fraction:
    """What no comparison can see: float64's last bits, and its underflow in every step."""
    return abs(x) / 2**51 + Fraction(steps, 2**1060)
