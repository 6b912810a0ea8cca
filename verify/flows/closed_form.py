"""Closed forms evaluated until the digits asked for stand.

A closed form is evaluated with more and more digits until two evaluations agree. The trap is a
modulus that rounds to 1 in both, as near a separatrix; so the first precision already holds what
exact inputs of that size can make nearly cancel: `Motion.lost` and twice the digits in which the
inputs are written.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mpmath.ctx_mp import MPContext

from verify.arithmetic.exact import of_mpf
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.motion import Context, Motion, number

_GUARD = 15
_MORE = 10  # digits that the second evaluation has more than the first
MOST_DIGITS = 10_000
_MOST_BITS = 1 << 20  # of exponents: a state beyond it is of no use to anyone
_SAFETY = 2  # the better of two values is nearer to the truth than they are to each other

Start = tuple[Fraction, Fraction]  # p, q


@dataclass(frozen=True)
class Evaluation:
    """(p, q) with a bound of the error of each."""

    p: Fraction
    q: Fraction
    bound: Fraction


def evaluate(
    motion: Motion, start: Start, time: Fraction, digits: int, others: Iterable[Fraction] = ()
) -> Evaluation:
    """φ_time(start), its bound at most 10^−digits times the largest of |p|, |q| at both ends.

    `others`: the parameters in the motion. Raises NoFlowError where the solution blows up before.
    """
    inputs = (*start, time, *others)
    first = digits + _GUARD + motion.lost + sum(2 * _length(x) for x in inputs)
    least = max(map(abs, start))
    while first <= MOST_DIGITS:
        contexts = [_context(n) for n in (first, first + _MORE)]
        _check_end(motion, time, contexts[0])
        values = [_state(motion, time, mp) for mp in contexts]
        if None not in values:
            found = _agreed(values, least, digits)
            if found:
                return found
        first = 2 * first
    raise NoFlowError(f"the closed form loses more than {MOST_DIGITS} digits there")


def blow_up(motion: Motion, sign: int, digits: int) -> Fraction | None:
    """|t| at which the solution ends, forwards (1) or backwards (−1); None where it does not."""
    end = motion.blow_up(_context(digits + _GUARD + motion.lost), sign)
    return None if end is None else of_mpf(end)


def _check_end(motion: Motion, time: Fraction, mp: Context) -> None:
    """NoFlowError where the solution blows up before that time, or cannot be told not to."""
    end = motion.blow_up(mp, -1 if time < 0 else 1)
    if end is not None and number(mp, abs(time)) >= end * (1 - mp.ldexp(1, -mp.prec // 2)):
        sign = "−" if time < 0 else ""
        raise NoFlowError(f"the exact solution blows up at t = {sign}`{mp.nstr(end, 12)}`")


def _state(motion: Motion, time: Fraction, mp: Context) -> tuple[Any, Any] | None:
    """(p, q) by one evaluation; None where it fails for want of digits."""
    try:
        p, q = motion.state(mp, number(mp, time))
    except (ArithmeticError, ValueError):
        return None
    if not all(isinstance(x, mp.mpf) and mp.isfinite(x) for x in (p, q)):
        return None
    return p, q


def _agreed(values: list[Any], least: Fraction, digits: int) -> Evaluation | None:
    """The second value on a grid of the digits asked for, where the first agrees with it."""
    finer = values[1][0].context
    if not _moderate(finer, values):
        return None
    before, after = ([finer.mpf(x) for x in z] for z in values)  # in one context
    scale = max(number(finer, least), *map(abs, after))
    if scale == 0:
        return Evaluation(Fraction(0), Fraction(0), Fraction(0)) if before == after else None
    apart = max(abs(x - y) for x, y in zip(before, after, strict=True))
    unit = finer.mag(scale) - 1 - (digits * 3322 // 1000 + 8)
    grid = Fraction(2) ** int(unit)
    # What is far below the grid may have too small an exponent for a fraction.
    p, q = (int(finer.nint(finer.ldexp(x, -unit))) * grid for x in after)
    bound = _SAFETY * _up(finer, apart, unit) * grid + grid
    return (
        Evaluation(p, q, bound) if bound * 10**digits <= _down(finer, scale, unit) * grid else None
    )


def _moderate(mp: Context, values: list[Any]) -> bool:
    """Whether both are in range; NoFlowError where they agree that the solution is not."""
    sizes = [max((mp.mag(x) for x in z if x), default=0) for z in values]
    if min(sizes) > _MOST_BITS and abs(sizes[0] - sizes[1]) <= 1:
        raise NoFlowError(f"the exact solution is beyond `2^{_MOST_BITS}` by then")
    return max(sizes) <= _MOST_BITS


def _up(mp: Context, x: Any, unit: int) -> int:
    return int(mp.ceil(mp.ldexp(x, -unit)))


def _down(mp: Context, x: Any, unit: int) -> int:
    return int(mp.floor(mp.ldexp(x, -unit)))


def _context(digits: int) -> Context:
    mp = MPContext()
    mp.dps = digits
    return mp


def _length(x: Fraction) -> int:
    """The decimal digits in which a rational is written."""
    return (x.numerator.bit_length() + x.denominator.bit_length()) * 3 // 10
