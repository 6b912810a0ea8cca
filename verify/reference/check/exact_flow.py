"""The exact flow by high-order Taylor steps, twice: with another tolerance and another order.

The coefficients of the solution come from the recursion (k+1) z_(k+1) = f_k; a step ends where its
last terms reach the tolerance (Jorba, Zou, Experimental Mathematics 14 (2005) 99–117). The result
is what two such integrations say, with several times their difference as its radius: an estimate.
"""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import flint

from verify.arithmetic.exact import short
from verify.reference.check.taylor import number
from verify.reference.check.textbook import Field, Vector, flow_series, polynomials

_MORE = 8  # digits, and orders, of the second integration
_MOST_STEPS = 5_000
_BURST, _STOPPED = 40, 60  # |z| above its first size, and steps below the first, in powers of two


class NoSolutionError(Exception):
    """The solution could not be followed; the message says why."""


class BlowsUpError(NoSolutionError):
    """The solution grows beyond every bound before the last of the times."""


def states_at(
    field: Field, start: Mapping[str, Fraction], times: Sequence[Fraction], digits: int
) -> tuple[list[Vector], NoSolutionError | None]:
    """Return balls of z at the times, which ascend from 0, and the reason if some were not reached.

    `start`: the coordinates and, where H depends on it, t.
    """
    bits = math.ceil(3.33 * (digits + _MORE)) + 64
    with flint.ctx.workprec(bits):
        # Another tolerance and another order: an error of the method would have to be the same in
        # both to go unseen.
        rough, why = _taylor_solution(field, start, times, digits)
        fine, why_fine = _taylor_solution(field, start, times, digits + _MORE)
        both = [_merge(*pair, digits) for pair in zip(rough, fine, strict=False)]
        return both, why or why_fine


def _merge(rough: Vector, fine: Vector, digits: int) -> Vector:
    distance = max((abs(a - b).upper() for a, b in zip(rough, fine, strict=True)), key=_log_size)
    scale = max((abs(x).upper() for x in fine), key=_log_size)
    # An estimate, not a bound: the factor 4 and the term of 10^(−digits − 2) allow for errors that
    # both integrations share.
    radius = 4 * distance + scale * flint.arb(10) ** (-digits - 2)
    return [x.mid() + flint.arb(0, 1) * radius for x in fine]


def _taylor_solution(
    field: Field, start: Mapping[str, Fraction], times: Sequence[Fraction], digits: int
) -> tuple[list[Vector], NoSolutionError | None]:
    order = digits + digits // 4 + 10
    z: Vector = [flint.arb(number(start[name])) for name in field.names]
    first, done, states = _largest_log(z), Fraction(0), []
    waiting = list(times)
    shortest: float | None = None
    for _ in range(_MOST_STEPS):
        while waiting and waiting[0] == done:
            states.append(z)
            waiting.pop(0)
        if not waiting:
            return states, None
        t = flint.arb(number(start.get("t", Fraction(0)) + done))
        zs = flow_series(field.slopes, z, t, order)
        reach = _reach(zs, digits)
        if not all(x.is_finite() for vector in zs for x in vector):
            return states, NoSolutionError("H is not defined there")
        shortest = reach if shortest is None else shortest
        # Both a state 2^40 times larger and steps 2^60 times shorter than at first: near a pole in
        # time they go together.
        if _largest_log(z) > first + _BURST and reach < shortest - _STOPPED:
            return states, BlowsUpError("the solution blows up before")
        after = done + _power_of_two(reach)
        while waiting and waiting[0] <= after:
            states.append(_evaluate_at(zs, waiting.pop(0) - done))
        z, done = _evaluate_at(zs, after - done), after
    return states, NoSolutionError(f"{_MOST_STEPS} steps lead only to t = {short(done)}")


def _reach(zs: list[Vector], digits: int) -> float:
    """Return lg₂ of a step whose last terms are 10^−digits of the state, or of its speed where
    it is 0."""
    scale = next((size for size in map(_largest_log, zs) if size > -math.inf), 0.0)
    reaches = []
    for k in (len(zs) - 1, len(zs) - 2):
        last = _largest_log(zs[k])
        if last > -math.inf:
            reaches.append((scale - 3.3219281 * digits - last) / k)
    return min(reaches, default=60.0)  # a polynomial in t


def _evaluate_at(zs: list[Vector], h: Fraction) -> Vector:
    """Return the polynomials at h, without their rounding errors: the other integration shows
    these."""
    return [x.mid() for x in polynomials(zs, flint.arb(number(h)))]


def _power_of_two(exponent: float) -> Fraction:
    """Return 2^exponent, rounded down a little, with few bits."""
    whole = math.floor(exponent)
    return Fraction(math.floor(1024 * 2 ** (exponent - whole)), 1024) * Fraction(2) ** whole


def _largest_log(z: Sequence[Any]) -> float:
    """Return about lg₂ of the largest |coordinate|."""
    return max(_log_size(x) for x in z)


def _log_size(x: Any) -> float:
    """Return about lg₂ |x| of a ball's middle, however large or small."""
    midpoint = x.mid()
    if not midpoint.is_finite() or midpoint.is_zero():
        return -math.inf if midpoint.is_zero() else math.inf
    mantissa, exponent = midpoint.man_exp()
    return float(abs(int(mantissa)).bit_length() + int(exponent))
