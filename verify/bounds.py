"""Error bounds of runs, estimated: what rounding left of the digits.

float64, up to `DIRECT_STEPS` steps: held against mpfr from the exact inputs, at a precision that
is itself confirmed. Beyond: against a compensated run (see `verify.kernel`), by four times the
greatest difference at any of the checkpoints on the way, p and q taken together, since a single
difference may be small by chance. That leaves the rounding of h, the parameters and the initial
values aside. Where errors grow linearly in time it shifts the phase by about T·2⁻⁵³, while the
rounding of N ≥ 20,000 states shifts it by about √N·T·2⁻⁵³/5; where they grow exponentially, as near
a separatrix, every rounding counts alike, and the states' are N to one. Where the two orbits differ
by more than their size no value is given.

Every other arithmetic: held against a rerun with 15 more digits, at a precision that is raised
until the digits asked for stand. A rerun confirms a run only where the two differ little: once the first has lost
every digit, as on a chaotic orbit, the second may have lost as many more. So where they differ by
more than `_LINEAR` of the orbit's size the precision is doubled instead; where that does not end,
the run is "unresolved" and no value is given. An estimate is no certificate, and is called
`estimated`.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from verify import arithmetic as number_systems
from verify.exact import magnitude
from verify.number_system import Arithmetic
from verify.stepping import Job, Outcome

DIRECT_STEPS = 20_000
Bounded = dict[str, tuple[Fraction, Fraction]]  # values with their bounds
Status = Literal["finished", "left range", "unresolved"]

REFERENCE = "mpfr"  # mpmath finds the same, and takes five to ten times as long
_REFERENCE_DIGITS = 40
_MORE_DIGITS = 15
_ATTEMPTS = 6
_FOLLOWED_STEPS = 1000  # a chaotic orbit is followed so far; it loses digits at every step
_LINEAR = Fraction(1, 100)
_STATE = ("p", "q")


@dataclass(frozen=True)
class Bounds:
    """Values with bounds, how they were got, and how the run ended."""

    values: Bounded
    method: str
    status: Status = "finished"
    failed_step: int | None = None


def working_digits(digits: int, steps: int) -> int:
    """Digits enough that rounding, growing at most like N² on a bounded orbit, stays below."""
    return digits + 10 + 2 * len(str(steps))


def bounded(
    job: Job,
    own: Arithmetic,
    first: Outcome,
    digits: int,
    known: Bounded,
    reference: str = REFERENCE,
) -> Bounds:
    """The values of the run `first` of the job with their bounds.

    `known`: what a proof gives for observables that were not run. `reference`: the arithmetic that
    float64 is held against.
    """
    if own.name != "float64":
        return _resolved(job, own, first, digits)
    if first.done < job.steps:
        return Bounds({}, "none", "left range", first.done + 1)
    direct = job.steps <= DIRECT_STEPS
    found = _against(job, first, reference) if direct else _compensated(job, first)
    values = dict(found.values)
    better = (known | values).get("lambda")
    if "lambda_plain" in values and better:
        # The closed form is the better value of the same product, up to its own error.
        plain, (closed, bound) = first.values["lambda_plain"], better
        values["lambda_plain"] = plain, abs(plain - closed) + bound
    return Bounds(values, found.method, found.status, found.failed_step)


def _against(job: Job, first: Outcome, name: str) -> Bounds:
    reference = number_systems.get(name, working_digits(_REFERENCE_DIGITS, job.steps))
    second = job.go(reference)
    method = f"rerun in {name} with {_REFERENCE_DIGITS} digits"
    if second.done == job.steps and _spread(first, second) < _LINEAR:
        return Bounds(_differences(first, second.values, job.steps), method)
    # float64 has lost every digit, so the reference has lost many: is it good for the rest?
    if job.steps > _FOLLOWED_STEPS:
        return _compensated(job, first)
    true = _resolved(job, reference, second, 1)
    if true.status != "finished":
        return Bounds({}, f"{method}, which finds another orbit", "unresolved")
    values = {n: value for n, (value, _) in true.values.items()}
    return Bounds(_differences(first, values, job.steps), method)


def _compensated(job: Job, first: Outcome) -> Bounds:
    method = "four times the difference from a compensated run"
    second = job.go(number_systems.get("float64", 17), compensated=True)
    if second.done < job.steps:
        return Bounds({}, f"{method}, which left the range", "unresolved")
    spread = _spread(first, second)
    if spread > 1:  # two orbits, not one with errors
        return Bounds({}, f"{method}, which is another orbit", "unresolved")
    spread *= 4
    found = {}
    for name, x in first.values.items():
        largest = max(abs(a[name]) for a in (*first.trail, *second.trail))
        if name in _STATE:
            difference = spread * largest
        else:
            pairs = zip(first.trail, second.trail, strict=True)
            difference = 4 * max(abs(a[name] - b[name]) for a, b in pairs)
        found[name] = x, difference + _floor(x, job.steps)
    return Bounds(found, method)


def _differences(first: Outcome, true: dict[str, Fraction], steps: int) -> Bounded:
    return {n: (x, abs(x - true[n]) + _floor(true[n], steps)) for n, x in first.values.items()}


def _floor(x: Fraction, steps: int) -> Fraction:
    """What no comparison can see: float64's last bits, and its underflow in every step."""
    return abs(x) / 2**51 + Fraction(steps, 2**1060)


def _spread(first: Outcome, second: Outcome) -> Fraction:
    """The greatest difference of p or q at any checkpoint, relative to the orbit's size."""
    spread = Fraction(0)
    for name in _STATE:
        size = max(abs(a[name]) for a in (*first.trail, *second.trail))
        pairs = zip(first.trail, second.trail, strict=False)
        if size:
            spread = max(spread, *(abs(a[name] - b[name]) / size for a, b in pairs))
    return spread


def _resolved(job: Job, own: Arithmetic, first: Outcome, digits: int) -> Bounds:
    """The values to so many digits, by raising the precision until a rerun confirms them."""
    for _ in range(_ATTEMPTS):
        finer = number_systems.get(own.name, _digits(own) + _MORE_DIGITS)
        second = job.go(finer)
        method = f"rerun with {_MORE_DIGITS} more digits"
        if first.done != second.done or not second.trail or _spread(first, second) > _LINEAR:
            if first.done == second.done < job.steps and not second.trail:
                return Bounds({}, method, "left range", second.done + 1)
            own = number_systems.get(own.name, 2 * _digits(own))
            first = job.go(own)
            continue
        if second.done < job.steps:
            return Bounds({}, method, "left range", second.done + 1)
        unit = Fraction(1, 2 ** (own.bits - 2))
        found = {
            n: (second.values[n], abs(x - second.values[n]) + unit * abs(x))
            for n, x in first.values.items()
        }
        missing = max(_missing(value, bound, digits) for value, bound in found.values())
        if missing <= 0:
            return Bounds(found, method)
        own = number_systems.get(own.name, _digits(own) + missing + 5)
        first = job.go(own)
    return Bounds({}, f"{_ATTEMPTS} reruns at rising precision that do not agree", "unresolved")


def _digits(own: Arithmetic) -> int:
    return own.bits * 30103 // 100000


def _missing(value: Fraction, bound: Fraction, digits: int) -> int:
    """How many of the digits asked for are not known yet; a value of 0 may stay unknown."""
    if bound == 0 or value == 0:
        return 0
    return digits - (magnitude(value) - magnitude(2 * bound))
