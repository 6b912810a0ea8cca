"""Closed forms in ball arithmetic: certified to any number of digits.

A ball holds the exact solution whatever the precision, and is wide or not finite where digits are
lost: near a separatrix, after a long time, close to a blow-up. Then the precision is doubled.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple, TypeVar

from flint import arb

from verify.arithmetic.arb import bounds
from verify.arithmetic.exact import plain
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import bits_for
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.named_system import Motion, exactly

MOST_DIGITS = 10_000
_MOST_PRECISION = 2 * bits_for(MOST_DIGITS)
_GUARD_BITS = 30  # bits; cancellation in a formula typically loses fewer
_GRID_BITS = 8  # the allowed error is 2^_GRID_BITS units of the grid that values are rounded to
_MAX_EXPONENT = 1 << 20  # binary exponent; a larger state is of no use to anyone
_TIME_DIGITS = 12  # the digits to which a blow-up time is printed

Numbers = Sequence[Fraction]  # p, q; p1 … pn, q1 … qn
T = TypeVar("T")


class Evaluation(NamedTuple):
    """The coordinates of a state, with a bound of the error of each, which is certified."""

    coordinates: Numbers
    bound: Fraction


def evaluate(motion: Motion, start: Numbers, time: Fraction, digits: int) -> Evaluation:
    """Return φ_time(start), with a bound of at most 10^−digits times the largest coordinate.

    The largest coordinate is taken over both ends, in size.

    Raises NoFlowError if the solution blows up by then, and if the digits are not reached.
    """
    if motion.is_at_rest or time == 0:
        return Evaluation(start, Fraction(0))
    check_no_blow_up(motion, time)
    exact_time = exactly(time)
    return evaluate_enclosure(lambda: motion.state(arb(exact_time)), start, digits)


def evaluate_enclosure(
    state: Callable[[], Sequence[arb]], start: Numbers, digits: int
) -> Evaluation:
    """Return the numbers that the balls of `state` enclose, with a bound as in `evaluate`.

    Raises NoFlowError as `evaluate` does.
    """
    least = exactly(max(map(abs, start)))
    return try_precisions(lambda: _round_to_grid(state(), arb(least), digits), digits)


def try_precisions(attempt: Callable[[], T | None], digits: int) -> T:
    """Return the first value of `attempt` that is not None, as the precision doubles.

    Raises NoFlowError beyond the precision of `MOST_DIGITS` digits.
    """
    return try_precisions_from(attempt, first_precision(digits))


def try_precisions_from(attempt: Callable[[], T | None], bits: int) -> T:
    """Return the value as `try_precisions` does, from a precision of `bits` bits on."""
    # Doubling costs at most twice the work of the last attempt in all.
    while bits <= _MOST_PRECISION:
        with working_precision(bits):
            value = attempt()
        if value is not None:
            return value
        bits *= 2
    raise NoFlowError(f"the closed form loses more than {MOST_DIGITS} digits there")


def first_precision(digits: int) -> int:
    """Return a number of bits that is likely to give `digits` digits."""
    return bits_for(digits) + _GUARD_BITS


def blow_up(motion: Motion, sign: int, digits: int) -> Fraction | None:
    """Return |t| of the blow-up, forwards (sign 1) or backwards (−1) in time; None if none occurs.

    The value has about `digits` digits and no bound.
    """
    end_of = motion.blow_up
    if end_of is None:
        return None

    def enclose_time() -> tuple[Fraction | None] | None:
        end = end_of(sign)
        if end is None:
            return (None,)
        is_accurate = end.is_finite() and end.rel_accuracy_bits() > bits_for(digits)
        low, high = bounds(end) if is_accurate else (Fraction(0), Fraction(0))
        return ((low + high) / 2,) if is_accurate else None

    return try_precisions(enclose_time, digits)[0]


def may_end_by(motion: Motion, time: Fraction) -> bool:
    """Return True if the solution blows up by that time, or if this is undecided."""
    end_of = motion.blow_up
    if end_of is None:
        return False
    # `motion.blow_up` takes the direction of time, and gives a positive time.
    sign, exact_time = (-1 if time < 0 else 1), exactly(abs(time))

    def has_ended() -> bool | None:
        end = end_of(sign)
        if end is None or end > exact_time:
            return False
        return True if end < exact_time else None

    try:
        return try_precisions(has_ended, 1)
    except NoFlowError:
        return True  # the blow-up is so near to `time` that no precision separates the two


def check_no_blow_up(motion: Motion, time: Fraction) -> None:
    """Raise NoFlowError if the solution blows up by that time, or if this is undecided."""
    if may_end_by(motion, time):
        sign = -1 if time < 0 else 1
        time_text = plain(blow_up(motion, sign, _TIME_DIGITS) or Fraction(0), _TIME_DIGITS)
        raise NoFlowError(
            f"the exact solution blows up at t = {'−' if time < 0 else ''}`{time_text}`"
        )


def _round_to_grid(state: Sequence[arb], least: arb, digits: int) -> Evaluation | None:
    """Round the state to a grid finer than the requested digits; None if its balls are too wide.

    Raises NoFlowError if the state is too large for any use.
    """
    if not all(x.is_finite() for x in state):
        return None
    scale = least
    for x in state:
        scale = scale.max(x.abs_lower())
    scale = scale.lower()
    mantissa, exponent = scale.man_exp()
    size = int(exponent) + int(mantissa).bit_length()  # scale ≥ 2^(size − 1)
    if scale > 0 and size > _MAX_EXPONENT:
        raise NoFlowError(f"the exact solution is beyond `2^{_MAX_EXPONENT}` by then")
    if not scale > 0 or size < -_MAX_EXPONENT:
        return None
    # One grid unit is 2^unit. As scale ≥ 2^(size − 1), 2^_GRID_BITS units are at most 10^−digits
    # of the scale: that is the largest error allowed.
    unit = size - 1 - bits_for(digits) - _GRID_BITS
    # Balls are scaled before they become fractions: the exponent of a coordinate far below the
    # grid may be too small for a fraction.
    rounded = [_round_ball(x * arb(2) ** -unit) for x in state]
    largest = max(error for _, error in rounded)
    if largest > 1 << _GRID_BITS:
        return None
    grid = Fraction(2) ** unit
    return Evaluation([whole * grid for whole, _ in rounded], largest * grid)


def _round_ball(x: arb) -> tuple[int, int]:
    """Return a whole number near the ball, and a bound of its distance to any point of the ball.

    A bound of 2·2^_GRID_BITS, which is not allowed, stands for a ball that is too wide or large.
    """
    nearest = (x.mid() + 0.5).floor().unique_fmpz()
    if nearest is None:
        return 0, 2 << _GRID_BITS
    error = (x - nearest).abs_upper().ceil().unique_fmpz()
    return int(nearest), 2 << _GRID_BITS if error is None else int(error)
