"""Error bounds of runs, estimated by reruns at higher precision.

A run is compared with a rerun with 15 more digits, at a precision that is raised until the
requested digits agree. A rerun confirms a run only where the two differ little: once the first has
lost every digit, as on a chaotic orbit, the second may have lost as many more. So where they differ
by more than `LINEAR` of the orbit's size the precision is doubled instead; where that does not end,
the run is "unresolved" and no value is given. An estimate is no certificate, and is called
`estimated`; `verify.runs.a_posteriori_bound` has rigorous bounds.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from verify import arithmetic as number_systems
from verify import observables
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course

BoundedValues = dict[str, tuple[Fraction, Fraction]]  # values with their bounds
Status = Literal["finished", "left range", "unresolved"]

_MORE_DIGITS = 15
_ATTEMPTS = 6
_DIGITS_OF_ZERO = 10  # more digits of a function than are asked for, where no change of it is seen
LINEAR = Fraction(1, 100)  # largest difference, in orbit sizes, by which a rerun confirms a run


@dataclass(frozen=True)
class Bounds:
    """Values with bounds, the method that gave them, and the end of the run."""

    values: BoundedValues
    method: str
    status: Status = "finished"
    failed_step: int | None = None
    rigorous: bool = False


def working_digits(digits: int, steps: int) -> int:
    """Return enough digits to keep rounding, which grows at most like N² if bounded, below them."""
    # N² has twice as many digits as N; the other 10 are a reserve.
    return digits + 10 + 2 * len(str(steps))


def spread(first: RunOutcome, second: RunOutcome, least: Fraction = Fraction(0)) -> Fraction:
    """Return the greatest relative difference of a coordinate at any checkpoint.

    It is relative to the greatest |coordinate| of the same letter, p or q, or to `least` if that is
    greater; of equations to the greatest of all.
    """
    spread, notes = Fraction(0), (*first.trail, *second.trail)
    for letter in sorted({name[0] for name in first.coordinates}):
        names = [name for name in first.coordinates if name[0] == letter]
        size = max(least, *(abs(a[name]) for a in notes for name in names))
        pairs = list(zip(first.trail, second.trail, strict=False))
        if size:
            differences = (abs(a[name] - b[name]) for a, b in pairs for name in names)
            spread = max(spread, *(x / size for x in differences))
    return spread


def _noise(arithmetic: Arithmetic, *runs: RunOutcome) -> Fraction:
    """Return the size below which a coordinate may be nothing but rounding, as p at an equilibrium.

    Such a coordinate has no digit that a higher precision confirms.
    """
    sizes = [abs(note[name]) for run in runs for note in run.trail for name in run.coordinates]
    return max(sizes, default=Fraction(0)) * Fraction(1, 2 ** (arithmetic.bits // 2))


def resolve(
    kernel_run: KernelRun, arithmetic: Arithmetic, first: RunOutcome, digits: int
) -> Course[Bounds]:
    """Return the values to `digits` digits; raise the precision until a rerun confirms them."""
    for _ in range(_ATTEMPTS):
        finer = number_systems.get(arithmetic.name, digits_of(arithmetic) + _MORE_DIGITS)
        second = yield from kernel_run.run_in_turn(finer)
        method = f"rerun with {_MORE_DIGITS} more digits"
        noise = _noise(arithmetic, first, second)
        if first.done != second.done or not second.trail or spread(first, second, noise) > LINEAR:
            if first.done == second.done < kernel_run.steps and not second.trail:
                return Bounds({}, method, "left range", second.done + 1)
            arithmetic = number_systems.get(arithmetic.name, 2 * digits_of(arithmetic))
            first = yield from kernel_run.run_in_turn(arithmetic)
            continue
        if second.done < kernel_run.steps:
            return Bounds({}, method, "left range", second.done + 1)
        # Both runs round their last values: their difference may be 0 by chance while the error is
        # not.
        unit = Fraction(1, 2 ** (arithmetic.bits - 2))
        values = {
            n: (
                second.values[n],
                abs(x - second.values[n]) + unit * _rounded_size(kernel_run, n, x),
            )
            for n, x in first.values.items()
        }
        # Such a coordinate is 0 as far as the runs tell.
        zeros = {n for n in first.coordinates if abs(values[n][0]) <= values[n][1] <= noise}
        missing = missing_in(kernel_run, {n: values[n] for n in values if n not in zeros}, digits)
        if missing <= 0:
            return Bounds(values, method)
        arithmetic = number_systems.get(arithmetic.name, digits_of(arithmetic) + missing + 5)
        first = yield from kernel_run.run_in_turn(arithmetic)
    return Bounds({}, f"{_ATTEMPTS} reruns at rising precision that do not agree", "unresolved")


def _rounded_size(run: KernelRun, name: str, value: Fraction) -> Fraction:
    """Return the size of the number whose rounding a value has: 1 + Λ for Λ by the product, I for
    the change of a function I."""
    return abs(value) + _initial_offset(name) + run.size_at_start(name)


def _initial_offset(name: str) -> int:
    """Return the number that the run subtracts in the end: 1 for Λ by the plain product, else 0."""
    observable = observables.find(name)
    return observable.begins if observable else 0


def digits_of(arithmetic: Arithmetic) -> int:
    """Return the number of decimal digits of an arithmetic."""
    # log10(2) = 0.30103.
    return arithmetic.bits * 30103 // 100000


def missing_digits(value: Fraction, bound: Fraction, digits: int) -> int:
    """Return the number of requested digits that are missing; 0 for a value or bound of 0."""
    if bound == 0 or value == 0:
        return 0
    # The digits between the first of the value and the first of twice the bound are certain.
    return digits - (magnitude(value) - magnitude(2 * bound))


def missing_in(run: KernelRun, values: BoundedValues, digits: int) -> int:
    """Return the greatest number of digits that a value lacks, of those that are asked for."""
    demanded = ((name, value) for name, value in values.items() if name not in run.aside)
    return max((_missing_of(run, name, *value, digits) for name, value in demanded), default=0)


def _missing_of(run: KernelRun, name: str, value: Fraction, bound: Fraction, digits: int) -> int:
    if abs(value) > bound:
        return missing_digits(value, bound, digits)
    if _initial_offset(name):
        value = Fraction(1)  # a product that may be exactly 1: no precision finds a digit of 0
    elif size := run.size_at_start(name):
        # So may the change of a function that is kept: a bound far below the function is enough.
        value, digits = size, digits + _DIGITS_OF_ZERO
    return missing_digits(value, bound, digits)
