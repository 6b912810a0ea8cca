"""Digits on demand: which arithmetic, how precise, and a rigorous bound where one can be had.

A run that carries the tangent map is certified (`verify.runs.a_posteriori`); where digits are
missing it is done again at the precision that gives them. How many will be missing is foreseen at
the first of its checkpoints, so that little is run in vain: where the tangent map grows linearly,
the bound grows like N³, and that of Λ like N⁴. Where there is no certificate the bound is estimated
(`verify.runs.estimated`).

The certificate of W grows like N⁹ and is 10⁵ to 10¹⁷ times its error, since it takes the worst of
every step for all of them. So the W of a short run, whose steps cost less than its certificate, is
held against that of a run with 20 more digits: what they differ by, and the certificate of the
second, bound its error, which the first of the two nearly is.
"""

from dataclasses import dataclass, replace
from fractions import Fraction

from verify import arithmetic as number_systems
from verify import observables
from verify.arithmetic.number_system import Arithmetic, NumberSystem, UnsupportedError
from verify.kernels.chunked_loop import Progress
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course
from verify.runs.a_posteriori import METHOD, certify
from verify.runs.estimated import (
    Bounds,
    digits_of,
    missing_digits,
    missing_of,
    resolved,
    working_digits,
)

_ATTEMPTS = 5
_BALL_ATTEMPTS = 6
_MOST_TIMES = 64  # the first attempt's digits, beyond which a ball is given up
WORTH_COMPILING = (
    60_000  # steps that repay a compiled kernel: it takes 0.2–0.8 s, mpfr 3–8 µs a step
)
_MOST_DEGREES = 8  # beyond, the Pfaffian of a certificate's matrices is too long
_SHORT = 1000  # steps that take less time than a certificate does: nothing is foreseen of them
_MORE = 20  # digits that cost such a run nothing, and are there for an observable that is small
_W = "symplectic_defect"
METHOD_OF_W = f"{METHOD}; W held against a run with {_MORE} more digits"


@dataclass(frozen=True)
class Measured:
    """Values with bounds, and the run that they are from."""

    bounds: Bounds
    arithmetic: str
    outcome: Outcome
    fallback: str = ""  # why another arithmetic was taken than the one that was asked for


def choose(kernel_run: KernelRun, digits: int) -> str:
    """The fastest arithmetic with rigorous bounds for so many digits, steps and these functions.

    float64 is not among them: it is what is under test, and its bounds are estimates.
    """
    *faster, last = number_systems.automatic()
    for system in faster:
        repaid = kernel_run.shares_kernel or worth_compiling(system, kernel_run.steps)
        worth = repaid and digits <= system.most_digits
        if worth and _fits(kernel_run, system.make(digits)):
            return system.name
    return last.name


def worth_compiling(system: NumberSystem, steps: int) -> bool:
    """Whether so many steps repay what the number system takes to compile a kernel."""
    return steps >= WORTH_COMPILING or not system.compiles


def _fits(kernel_run: KernelRun, arithmetic: Arithmetic) -> bool:
    """Whether it has the functions, and a step from the start stays within its range."""
    try:
        return kernel_run.fits(arithmetic)
    except UnsupportedError:
        return False


def measure(
    kernel_run: KernelRun, name: str, digits: int, progress: Progress | None = None
) -> Course[Measured]:
    """The run's values to so many digits in the arithmetic of that name, or in its fallback.

    A fixed-point run that leaves its range, and where a function is missing, or equations cannot be
    solved, goes to the one of every range.
    """
    try:
        if number_systems.get(name, digits).radius is not None:
            wider = number_systems.get(name, working_digits(digits, kernel_run.steps))
            bounds, run = enclosed(kernel_run, wider, digits, progress)
            return Measured(bounds, name, run)
        own = yield from certified(kernel_run, name, digits, progress)
        if isinstance(own, Measured):
            return own
        found = yield from _estimated(kernel_run, own, digits, progress)
        if not own.absolute or found.bounds.status == "finished":
            return found
        reason = found.outcome.reason or found.bounds.method
    except UnsupportedError as error:
        reason = str(error)
    last = number_systems.automatic()[-1].name
    return replace((yield from measure(kernel_run, last, digits, progress)), fallback=reason)


def enclosed(
    kernel_run: KernelRun, own: Arithmetic, digits: int, progress: Progress | None = None
) -> tuple[Bounds, Outcome]:
    """The values of a run in ball arithmetic, which encloses them, with the radii of their balls,
    and the run that they are of.

    Where the digits asked for are not all known, or the balls have grown so wide that nothing is,
    it is done again, in that case with twice the digits, and then with as many as the steps so far
    say that all of them cost. Where twice the digits end at the same step, the orbit has left the
    range or the domain there. Where too many digits or attempts would be needed, the run is
    "unresolved".
    """
    most, last = _MOST_TIMES * digits_of(own), None
    for attempt in range(1, _BALL_ATTEMPTS + 1):
        run = kernel_run.run(own, progress=progress)
        has, wanted = digits_of(own), 2 * digits_of(own)
        if run.done == kernel_run.steps:
            found = {n: (x, run.radii[n]) for n, x in run.values.items()}
            missing = max(missing_of(n, *value, digits) for n, value in found.items())
            if missing <= 0:
                return Bounds(found, f"ball arithmetic with {has} digits", rigorous=True), run
            wanted = has + missing + 5
        elif last and last[1] == run.done:
            # Twice as many digits would have carried a ball that had only grown too wide further.
            return Bounds({}, "ball arithmetic", "left range", run.done + 1), run
        elif last:  # about evenly, steps cost digits
            steps, spent = run.done - last[1], has - last[0]
            wanted = max(wanted, has + (kernel_run.steps - run.done) * spent // steps)
        if wanted > most or attempt == _BALL_ATTEMPTS:
            break
        last = has, run.done
        own = number_systems.get(own.name, wanted)
    method = f"balls that grow too wide in {has} digits; {wanted} would be tried next"
    return Bounds({}, method, "unresolved"), run


def certified(
    kernel_run: KernelRun, name: str, digits: int, progress: Progress | None = None
) -> Course[Measured | Arithmetic]:
    """The run's values to so many digits with rigorous bounds; where there are none, the arithmetic
    at the precision that was reached. Raises UnsupportedError."""
    own = number_systems.get(name, _first_digits(name, digits, kernel_run))
    if kernel_run.implicit or kernel_run.hamiltonian.degrees > _MOST_DEGREES:
        return own
    for _ in range(_ATTEMPTS):
        foreseen = _Foresight(kernel_run, own, digits) if kernel_run.steps > _SHORT else None
        outcome = yield from kernel_run.run_in_turn(
            own, tangent=True, progress=progress, enough=foreseen
        )
        if foreseen and foreseen.missing > 0:
            own = _finer(own, foreseen.missing)
            continue
        errors = certify(kernel_run, own, outcome) if outcome.done == kernel_run.steps else None
        if errors is None or len(errors) < len(outcome.values):
            break
        apart = yield from difference_of_w(kernel_run, own, outcome)
        if apart is not None:
            errors[_W] = min(errors[_W], apart)
        values = {n: (x, errors[n]) for n, x in outcome.values.items()}
        missing = max(missing_digits(*pair, digits) for pair in values.values())
        if missing <= 0:
            method = METHOD if apart is None else METHOD_OF_W
            return Measured(Bounds(values, method, rigorous=True), name, outcome)
        own = _finer(own, missing)
    return own


def difference_of_w(
    kernel_run: KernelRun, own: Arithmetic, outcome: Outcome
) -> Course[Fraction | None]:
    """A bound of W's error by a run with more digits and its certificate; None of a long run, of
    one without W, and where that has no certificate."""
    if kernel_run.steps > _SHORT or _W not in outcome.values:
        return None
    finer = number_systems.get(own.name, digits_of(own) + _MORE)
    second = yield from kernel_run.run_in_turn(finer, tangent=True)
    errors = certify(kernel_run, finer, second) if second.done == kernel_run.steps else None
    if errors is None or _W not in errors:
        return None
    return abs(outcome.values[_W] - second.values[_W]) + errors[_W]


def _estimated(
    kernel_run: KernelRun, own: Arithmetic, digits: int, progress: Progress | None
) -> Course[Measured]:
    first = yield from kernel_run.run_in_turn(own, progress=progress)
    if own.absolute and first.done < kernel_run.steps:
        bounds = Bounds({}, "", "left range", first.done + 1)
    else:
        bounds = yield from resolved(kernel_run, own, first, digits)
    return Measured(bounds, own.name, first)


def _first_digits(name: str, digits: int, kernel_run: KernelRun) -> int:
    if not number_systems.about(name).compiles:
        return working_digits(digits, kernel_run.steps) + (
            _MORE if kernel_run.steps <= _SHORT else 0
        )
    # Formats come in steps of 8 to 20 digits, and foresight costs a sixteenth of the run.
    time = kernel_run.steps * kernel_run.start["h"]
    return digits + 3 + len(str(kernel_run.steps)) + len(str(int(time)))


def _finer(own: Arithmetic, missing: int) -> Arithmetic:
    return number_systems.get(own.name, digits_of(own) + missing + 2)


def power_of(name: str) -> int:
    """The power of N by which a value's bound grows where the tangent map grows linearly."""
    each = observables.by_name().get(name)
    return each.growth if each else 3


class _Foresight:
    """Asked at a run's first checkpoint whether its digits will do; `missing` says how many."""

    def __init__(self, kernel_run: KernelRun, own: Arithmetic, digits: int) -> None:
        self.kernel_run, self.own, self.digits, self.missing = kernel_run, own, digits, 0

    def __call__(self, outcome: Outcome) -> bool:
        errors = certify(self.kernel_run, self.own, outcome, 0)
        if errors is None:  # let it run: what follows is for estimates
            return True
        growth = Fraction(self.kernel_run.steps, int(outcome.tangents[0]["done"]))
        note, seen = outcome.trail[0], outcome.tangents[0]
        sizes = {n: abs(x) for n, x in note.items()}
        largest = max(sizes[name] for name in outcome.coordinates)
        sizes |= dict.fromkeys(outcome.coordinates, largest)
        if "lambda" in sizes:
            sizes["lambda"] = max(abs(seen["least"]), abs(seen["most"]))
        short = [
            missing_digits(sizes[n], error * growth ** power_of(n), self.digits)
            for n, error in errors.items()
            if sizes.get(n)
        ]
        self.missing = max(0, *short) if short else 0
        return self.missing == 0
