"""Digits on demand: the choice of arithmetic and precision, with rigorous bounds where possible.

A run that carries the tangent map is certified (`verify.runs.a_posteriori_bound`); if digits are
missing, it is done again at the precision that gives them. The first checkpoint of a long run
forecasts how many will be missing, so that few steps are made in vain: where the tangent map grows
linearly, the bound grows like N³, and that of Λ like N⁴. Without a certificate the bound is
estimated (`verify.runs.estimates`).

W is the symplectic defect MᵀΩM − Ω of all steps. Its certified bound grows like N⁹ and is 10⁵ to
10¹⁷ times its error, since it takes the worst step for all steps. So the W of a short run, whose
steps cost less than its certificate, is compared with that of a run with 20 more digits. Their
difference plus the certified bound of the second is a bound of the error of the first; it is nearly
the difference alone.
"""

from dataclasses import dataclass, replace
from fractions import Fraction

from verify import arithmetic as number_systems
from verify import observables
from verify.arithmetic.number_system import Arithmetic, NumberSystem, UnsupportedError
from verify.kernels.chunked_loop import Progress
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course
from verify.runs.a_posteriori_bound import METHOD, certify
from verify.runs.estimates import (
    Bounds,
    digits_of,
    missing_in,
    resolve,
    working_digits,
)
from verify.runs.restarted_certificate import certify_restarted

_ATTEMPTS = 5
_BALL_ATTEMPTS = 6
_LARGEST_PRECISION_RATIO = 64  # digits in balls, over those of the first attempt; then it ends
# The least number of steps that repay a compiled kernel: compiling takes 0.2–0.8 s, and a step in
# mpfr 3–8 µs.
WORTH_COMPILING = 60_000
_SHORT_RUN_STEPS = 1000  # a shorter run takes less time than a certificate, and has no forecast
_EXTRA_DIGITS = 20  # they cost a short run next to nothing, and a small observable needs them
_W = "symplectic_defect"
METHOD_OF_W = f"{METHOD}; W held against a run with {_EXTRA_DIGITS} more digits"


@dataclass(frozen=True)
class Measurement:
    """Values with bounds, and the run that gave them."""

    bounds: Bounds
    arithmetic: str
    outcome: RunOutcome
    fallback: str = ""  # why an arithmetic other than the requested one was taken


def choose(kernel_run: KernelRun, digits: int) -> str:
    """Return the name of the fastest arithmetic with rigorous bounds that suits the run.

    float64 is not among them: it is itself under test.
    """
    *faster, last = number_systems.automatic()
    for system in faster:
        # A kernel that several runs share is compiled once for all of them.
        repaid = kernel_run.shares_kernel or worth_compiling(system, kernel_run.steps)
        worth = repaid and digits <= system.most_digits
        if worth and _fits(kernel_run, system.make(digits)):
            return system.name
    return last.name


def worth_compiling(system: NumberSystem, steps: int) -> bool:
    """Return True if the number system compiles nothing, or if the steps repay compiling."""
    return steps >= WORTH_COMPILING or not system.compiles


def _fits(kernel_run: KernelRun, arithmetic: Arithmetic) -> bool:
    """Return True if the arithmetic has H's functions, and holds a step from the start."""
    try:
        return kernel_run.fits(arithmetic)
    except UnsupportedError:
        return False


def measure(
    kernel_run: KernelRun, name: str, digits: int, progress: Progress | None = None
) -> Course[Measurement]:
    """Measure the run's values to `digits` digits in the arithmetic `name`, or in its fallback.

    The fallback is the arithmetic of unlimited range. It is taken if a fixed-point run leaves its
    range or has no confirmed values, if a function is missing, and if equations cannot be solved.
    """
    try:
        if number_systems.get(name, digits).radius is not None:
            wider = number_systems.get(name, working_digits(digits, kernel_run.steps))
            bounds, run = run_in_balls(kernel_run, wider, digits, progress)
            return Measurement(bounds, name, run)
        certificate = yield from certify_run(kernel_run, name, digits, progress)
        if isinstance(certificate, Measurement):
            return certificate
        estimate = yield from _estimate(kernel_run, certificate, digits, progress)
        if not certificate.absolute or estimate.bounds.status == "finished":
            return estimate
        reason = estimate.outcome.reason or estimate.bounds.method
    except UnsupportedError as error:
        reason = str(error)
    if (lighter := kernel_run.lighter).observables < kernel_run.observables:
        return (yield from measure(lighter, name, digits, progress))
    last = number_systems.automatic()[-1].name
    return replace((yield from measure(kernel_run, last, digits, progress)), fallback=reason)


def run_in_balls(
    kernel_run: KernelRun, arithmetic: Arithmetic, digits: int, progress: Progress | None = None
) -> tuple[Bounds, RunOutcome]:
    """Do the run in ball arithmetic; return its values with the radii of their balls, and the run.

    - If digits are missing at the end, the run is done again with these and 5 more.
    - If the balls grow too wide on the way, it is done again with twice the digits; after that with
      as many as all steps cost at the rate of those done so far, and at least twice.
    - If a run ends at the same step as the one before it, the orbit has left the range or the
      domain there.
    - If too many digits or attempts would be needed, the run is "unresolved".
    """
    most, last = _LARGEST_PRECISION_RATIO * digits_of(arithmetic), None
    for attempt in range(1, _BALL_ATTEMPTS + 1):
        run = kernel_run.run(arithmetic, progress=progress)
        has, next_digits = digits_of(arithmetic), 2 * digits_of(arithmetic)
        if run.done == kernel_run.steps:
            values = {n: (x, run.radii[n]) for n, x in run.values.items()}
            missing = missing_in(kernel_run, values, digits)
            if missing <= 0:
                return Bounds(values, f"ball arithmetic with {has} digits", rigorous=True), run
            next_digits = has + missing + 5
        elif last and last[1] == run.done:
            # Twice the digits would have carried a ball further if it had only grown too wide.
            return Bounds({}, "ball arithmetic", "left range", run.done + 1), run
        elif last:  # steps lose digits at about an even rate
            steps, spent = run.done - last[1], has - last[0]
            next_digits = max(next_digits, has + (kernel_run.steps - run.done) * spent // steps)
        if next_digits > most or attempt == _BALL_ATTEMPTS:
            break
        last = has, run.done
        arithmetic = number_systems.get(arithmetic.name, next_digits)
    method = f"balls that grow too wide in {has} digits; {next_digits} would be tried next"
    return Bounds({}, method, "unresolved"), run


def certify_run(
    kernel_run: KernelRun, name: str, digits: int, progress: Progress | None = None
) -> Course[Measurement | Arithmetic]:
    """Return the run's values to `digits` digits with rigorous bounds.

    If there are no such bounds, returns instead the arithmetic at the precision that was reached.
    Raises UnsupportedError.
    """
    arithmetic = number_systems.get(name, _first_digits(name, digits, kernel_run))
    if not kernel_run.certifiable:
        return arithmetic
    for _ in range(_ATTEMPTS):
        foreseen = (
            _Foresight(kernel_run, arithmetic, digits)
            if kernel_run.steps > _SHORT_RUN_STEPS
            else None
        )
        outcome = yield from kernel_run.run_in_turn(
            arithmetic, tangent=True, progress=progress, enough=foreseen
        )
        if foreseen and foreseen.missing > 0:
            arithmetic = _finer(arithmetic, foreseen.missing)
            continue
        errors = (
            certify(kernel_run, arithmetic, outcome) if outcome.done == kernel_run.steps else None
        )
        if errors is None or not outcome.values.keys() - kernel_run.aside <= errors.keys():
            break
        # The certified bound of W is far too wide: a second run of a short run gives a better one.
        bound_of_w = yield from difference_of_w(kernel_run, arithmetic, outcome)
        if bound_of_w is not None:
            errors[_W] = min(errors[_W], bound_of_w)
        values = {n: (x, errors[n]) for n, x in outcome.values.items() if n in errors}
        missing = missing_in(kernel_run, values, digits)
        if missing <= 0:
            method = METHOD if bound_of_w is None else METHOD_OF_W
            return Measurement(Bounds(values, method, rigorous=True), name, outcome)
        arithmetic = _finer(arithmetic, missing)
    if not kernel_run.hamiltonian.has_energy:
        restarted = yield from certify_restarted(kernel_run, arithmetic, digits, progress)
        if restarted is not None:
            return Measurement(restarted[0], name, restarted[1])
    return arithmetic


def difference_of_w(
    kernel_run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome
) -> Course[Fraction | None]:
    """Return a bound of W's error from a run with more digits and its certificate.

    None for a long run, for one without W, and if the finer run has no certificate.
    """
    if kernel_run.steps > _SHORT_RUN_STEPS or _W not in outcome.values:
        return None
    finer = number_systems.get(arithmetic.name, digits_of(arithmetic) + _EXTRA_DIGITS)
    second = yield from kernel_run.run_in_turn(finer, tangent=True)
    errors = certify(kernel_run, finer, second) if second.done == kernel_run.steps else None
    if errors is None or _W not in errors:
        return None
    return abs(outcome.values[_W] - second.values[_W]) + errors[_W]


def _estimate(
    kernel_run: KernelRun, arithmetic: Arithmetic, digits: int, progress: Progress | None
) -> Course[Measurement]:
    first = yield from kernel_run.run_in_turn(arithmetic, progress=progress)
    if arithmetic.absolute and first.done < kernel_run.steps:
        bounds = Bounds({}, "", "left range", first.done + 1)
    else:
        bounds = yield from resolve(kernel_run, arithmetic, first, digits)
    return Measurement(bounds, arithmetic.name, first)


def _first_digits(name: str, digits: int, kernel_run: KernelRun) -> int:
    if not number_systems.about(name).compiles:
        return working_digits(digits, kernel_run.steps) + (
            _EXTRA_DIGITS if kernel_run.steps <= _SHORT_RUN_STEPS else 0
        )
    # Few digits are tried first: a forecast of too few costs only a sixteenth of the run, and
    # formats come in steps of 8 to 20 digits.
    time = kernel_run.steps * kernel_run.start["h"]
    return digits + 3 + len(str(kernel_run.steps)) + len(str(int(time)))


def _finer(arithmetic: Arithmetic, missing: int) -> Arithmetic:
    return number_systems.get(arithmetic.name, digits_of(arithmetic) + missing + 2)


def power_of(name: str) -> int:
    """Return the power of N by which a value's bound grows if the tangent map grows linearly."""
    observable = observables.find(name)
    return observable.growth if observable else 3


class _Foresight:
    """A forecast, at a run's first checkpoint, of whether its digits suffice.

    A call returns True, and the run goes on, if they do or if there is no certificate. `missing` is
    the number of digits that will be missing.
    """

    def __init__(self, kernel_run: KernelRun, arithmetic: Arithmetic, digits: int) -> None:
        self.kernel_run = kernel_run
        self.arithmetic = arithmetic
        self.digits = digits
        self.missing = 0

    def __call__(self, outcome: RunOutcome) -> bool:
        errors = certify(self.kernel_run, self.arithmetic, outcome, 0)
        if errors is None:  # there is no forecast: the run goes on to its end
            return True
        # The checkpoint comes after 1/growth of the steps; each bound is scaled by its power of N.
        growth = Fraction(self.kernel_run.steps, int(outcome.tangents[0]["done"]))
        note, records = outcome.trail[0], outcome.tangents[0]
        sizes = {n: abs(x) for n, x in note.items()}
        largest = max(sizes[name] for name in outcome.coordinates)
        sizes |= dict.fromkeys(outcome.coordinates, largest)
        if "lambda" in sizes:
            sizes["lambda"] = max(abs(records["least"]), abs(records["most"]))
        bounds = {n: error * growth ** power_of(n) for n, error in errors.items()}
        foreseen = {n: (sizes[n], bound) for n, bound in bounds.items() if n in sizes}
        self.missing = max(0, missing_in(self.kernel_run, foreseen, self.digits))
        return self.missing == 0
