"""Error bounds of runs, estimated by reruns at higher precision.

A run is held against a rerun with 15 more digits, at a precision that is raised until the digits
asked for stand. A rerun confirms a run only where the two differ little: once the first has lost
every digit, as on a chaotic orbit, the second may have lost as many more. So where they differ by
more than `LINEAR` of the orbit's size the precision is doubled instead; where that does not end,
the run is "unresolved" and no value is given. An estimate is no certificate, and is called
`estimated`; `verify.runs.a_posteriori` has rigorous bounds.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from verify import arithmetic as number_systems
from verify import observables
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import Arithmetic
from verify.hamiltonians.coordinates import PLANE
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course

Bounded = dict[str, tuple[Fraction, Fraction]]  # values with their bounds
Status = Literal["finished", "left range", "unresolved"]

_MORE_DIGITS = 15
_ATTEMPTS = 6
LINEAR = Fraction(1, 100)


@dataclass(frozen=True)
class Bounds:
    """Values with bounds, how they were got, and how the run ended."""

    values: Bounded
    method: str
    status: Status = "finished"
    failed_step: int | None = None
    rigorous: bool = False


def working_digits(digits: int, steps: int) -> int:
    """Digits enough that rounding, growing at most like N² on a bounded orbit, stays below."""
    return digits + 10 + 2 * len(str(steps))


def spread(first: Outcome, second: Outcome, least: Fraction = Fraction(0)) -> Fraction:
    """The greatest difference of a coordinate at any checkpoint, relative to the orbit's size in
    all of its kind, momenta or others.

    Where that is smaller than `least`, relative to `least`.
    """
    spread, both = Fraction(0), (*first.trail, *second.trail)
    for letter in PLANE:
        own = [name for name in first.coordinates if name[0] == letter]
        size = max(least, *(abs(a[name]) for a in both for name in own))
        pairs = list(zip(first.trail, second.trail, strict=False))
        if size:
            apart = (abs(a[name] - b[name]) for a, b in pairs for name in own)
            spread = max(spread, *(x / size for x in apart))
    return spread


def _noise(own: Arithmetic, *runs: Outcome) -> Fraction:
    """What in p or q may be nothing but rounding beside the orbit's size, as p at an equilibrium:
    no precision ends it."""
    sizes = [abs(at[name]) for run in runs for at in run.trail for name in run.coordinates]
    return max(sizes, default=Fraction(0)) * Fraction(1, 2 ** (own.bits // 2))


def resolved(kernel_run: KernelRun, own: Arithmetic, first: Outcome, digits: int) -> Course[Bounds]:
    """The values to so many digits, by raising the precision until a rerun confirms them."""
    for _ in range(_ATTEMPTS):
        finer = number_systems.get(own.name, digits_of(own) + _MORE_DIGITS)
        second = yield from kernel_run.run_in_turn(finer)
        method = f"rerun with {_MORE_DIGITS} more digits"
        noise = _noise(own, first, second)
        if first.done != second.done or not second.trail or spread(first, second, noise) > LINEAR:
            if first.done == second.done < kernel_run.steps and not second.trail:
                return Bounds({}, method, "left range", second.done + 1)
            own = number_systems.get(own.name, 2 * digits_of(own))
            first = yield from kernel_run.run_in_turn(own)
            continue
        if second.done < kernel_run.steps:
            return Bounds({}, method, "left range", second.done + 1)
        unit = Fraction(1, 2 ** (own.bits - 2))
        found = {
            n: (second.values[n], abs(x - second.values[n]) + unit * _rounded(n, x))
            for n, x in first.values.items()
        }
        lacking = (
            missing_of(name, *value, digits)
            for name, value in found.items()
            if not (
                name in first.coordinates and abs(value[0]) <= value[1] <= noise
            )  # 0, as far as is known
        )
        missing = max(lacking, default=0)
        if missing <= 0:
            return Bounds(found, method)
        own = number_systems.get(own.name, digits_of(own) + missing + 5)
        first = yield from kernel_run.run_in_turn(own)
    return Bounds({}, f"{_ATTEMPTS} reruns at rising precision that do not agree", "unresolved")


def _rounded(name: str, value: Fraction) -> Fraction:
    """The size of what was rounded on the way to a value."""
    return abs(value) + _begins(name)


def _begins(name: str) -> int:
    """What was taken off it in the end: Λ the plain way is a product less 1."""
    each = observables.by_name().get(name)
    return each.begins if each else 0


def digits_of(own: Arithmetic) -> int:
    """So many decimal digits it has."""
    return own.bits * 30103 // 100000


def missing_digits(value: Fraction, bound: Fraction, digits: int) -> int:
    """How many of the digits asked for are not known yet; a value of 0 may stay unknown."""
    if bound == 0 or value == 0:
        return 0
    return digits - (magnitude(value) - magnitude(2 * bound))


def missing_of(name: str, value: Fraction, bound: Fraction, digits: int) -> int:
    """The same for an observable of that name."""
    if _begins(name) and abs(value) <= bound:
        value = Fraction(1)  # a product that may be exactly 1: no precision finds a digit of 0
    return missing_digits(value, bound, digits)
