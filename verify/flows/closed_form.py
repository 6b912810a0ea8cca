"""Closed forms in ball arithmetic: certified, however many digits are asked for.

A ball holds the exact solution whatever the precision, and is wide or not finite where digits are
lost: near a separatrix, after a long time, close to a blow-up. Then the precision is doubled.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TypeVar

from flint import arb

from verify.arithmetic.arb import bounds
from verify.arithmetic.exact import plain
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import bits_for
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.motion import Motion, exactly

MOST_DIGITS = 10_000
_MOST_PRECISION = 2 * bits_for(MOST_DIGITS)
_GUARD = 30  # bits that a formula may well lose
_FINER = 8  # bits of a value beyond its digits
_MOST_BITS = 1 << 20  # of exponents: a state beyond it is of no use to anyone
_TOLD = 12  # digits of a time at which a solution ends

Numbers = Sequence[Fraction]  # p, q; p1 … pn, q1 … qn
Evaluation = tuple[Numbers, Fraction]  # with a bound of the error of each, which is certified
T = TypeVar("T")


def evaluate(motion: Motion, start: Numbers, time: Fraction, digits: int) -> Evaluation:
    """φ_time(start), its bound at most 10^−digits times the largest coordinate at both ends.

    Raises NoFlowError where the solution blows up before, and where the digits are not reached.
    """
    if motion.rest or time == 0:
        return start, Fraction(0)
    ends_after(motion, time)
    at = exactly(time)
    return enclosed(lambda: motion.state(arb(at)), start, digits)


def enclosed(state: Callable[[], Sequence[arb]], start: Numbers, digits: int) -> Evaluation:
    """What the balls of `state` hold, with a bound as `evaluate` has it; NoFlowError as there."""
    least = exactly(max(map(abs, start)))
    return until(lambda: _on_grid(state(), arb(least), digits), digits)


def until(found: Callable[[], T | None], digits: int) -> T:
    """What is found at the first precision that gives it. Raises NoFlowError."""
    return from_precision(found, first_precision(digits))


def from_precision(found: Callable[[], T | None], bits: int) -> T:
    """The same, with so many bits at first."""
    while bits <= _MOST_PRECISION:
        with working_precision(bits):
            value = found()
        if value is not None:
            return value
        bits *= 2
    raise NoFlowError(f"the closed form loses more than {MOST_DIGITS} digits there")


def first_precision(digits: int) -> int:
    """Bits that are likely to give so many digits."""
    return bits_for(digits) + _GUARD


def blow_up(motion: Motion, sign: int, digits: int) -> Fraction | None:
    """|t| at which the solution ends, forwards (1) or backwards (−1); None where it does not."""
    end_of = motion.blow_up
    if end_of is None:
        return None

    def found() -> tuple[Fraction | None] | None:
        end = end_of(sign)
        if end is None:
            return (None,)
        known = end.is_finite() and end.rel_accuracy_bits() > bits_for(digits)
        low, high = bounds(end) if known else (Fraction(0), Fraction(0))
        return ((low + high) / 2,) if known else None

    return until(found, digits)[0]


def ends_by(motion: Motion, time: Fraction) -> bool:
    """Whether the solution blows up until that time, or cannot be told not to."""
    end_of = motion.blow_up
    if end_of is None:
        return False
    sign, at = (-1 if time < 0 else 1), exactly(abs(time))

    def found() -> bool | None:
        end = end_of(sign)
        if end is None or end > at:
            return False
        return True if end < at else None

    try:
        return until(found, 1)
    except NoFlowError:
        return True  # a rational time, where the invariants are 0


def ends_after(motion: Motion, time: Fraction) -> None:
    """NoFlowError where the solution blows up until that time, or cannot be told not to."""
    if ends_by(motion, time):
        sign = -1 if time < 0 else 1
        told = plain(blow_up(motion, sign, _TOLD) or Fraction(0), _TOLD)
        raise NoFlowError(f"the exact solution blows up at t = {'−' if time < 0 else ''}`{told}`")


def _on_grid(state: Sequence[arb], least: arb, digits: int) -> Evaluation | None:
    """The state on a grid of the digits asked for, where its balls are no wider."""
    if not all(x.is_finite() for x in state):
        return None
    scale = least
    for x in state:
        scale = scale.max(x.abs_lower())
    scale = scale.lower()
    mantissa, exponent = scale.man_exp()
    size = int(exponent) + int(mantissa).bit_length()  # scale ≥ 2^(size − 1)
    if scale > 0 and size > _MOST_BITS:
        raise NoFlowError(f"the exact solution is beyond `2^{_MOST_BITS}` by then")
    if not scale > 0 or size < -_MOST_BITS:
        return None
    unit = size - 1 - bits_for(digits) - _FINER
    # What is far below the grid may have too small an exponent for a fraction.
    found = [_rounded(x * arb(2) ** -unit) for x in state]
    apart = max(error for _, error in found)
    if apart > 1 << _FINER:
        return None
    grid = Fraction(2) ** unit
    return [whole * grid for whole, _ in found], apart * grid


def _rounded(x: arb) -> tuple[int, int]:
    """A whole number near the ball, and a bound of the distance of all of the ball from it."""
    whole = (x.mid() + 0.5).floor().unique_fmpz()
    if whole is None:
        return 0, 2 << _FINER
    error = (x - whole).abs_upper().ceil().unique_fmpz()
    return int(whole), 2 << _FINER if error is None else int(error)
