"""The motions that reference data are compared with, in balls: a scheme's orbit and the exact flow.

The orbit's balls are rigorous, as are the sums and products over its steps that a row contains.

The exact flow is followed by high-order Taylor steps, twice: with another tolerance and another
order. The coefficients of the solution come from the recursion (k+1) z_(k+1) = f_k; a step ends
at the size at which its last terms reach the tolerance (Jorba, Zou, Experimental Mathematics 14
(2005) 99–117). The result is the middle of the finer integration, with several times the difference
of the two as its radius: an estimate.
"""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any

import flint

from verify.arithmetic.exact import short
from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import (
    Step,
    TextbookField,
    Vector,
    defect,
    flow_series,
    identity,
    polynomials,
)
from verify.reference.make.models import AnyRun


class TooWideError(Exception):
    """A ball is too wide to decide a question."""


class BallOrbit:
    """The orbit of a run, from its start: with det J and S of its steps, and the product of all
    Jacobians."""

    def __init__(self, field: TextbookField, step: Step, run: AnyRun) -> None:
        start, self._size = run.start, Fraction(run.step_size)
        self.field, self.step, self.h = field, step, flint.arb(number(self._size))
        self.z: Vector = [flint.arb(number(start[name])) for name in field.names]
        self._t0 = start.get("t", Fraction(0))
        self.done, self.lam, self.squares, self.largest = 0, *(flint.arb(0) for _ in range(3))
        self._square = len(field.names), len(field.names)
        self.matrix = flint.arb_mat(*self._square, identity(len(field.names)))
        self._next: tuple[Vector, flint.arb_mat] | None = None

    @property
    def t(self) -> Number:
        """The time of the present state."""
        return flint.arb(number(self._t0 + self.done * self._size))

    def look_ahead(self) -> tuple[Vector, flint.arb_mat]:
        """Return the state after the next step, and that step's Jacobian."""
        if self._next is None:
            after, jacobian = self.step(self.z, self.h, self.t)
            self._next = after, flint.arb_mat(*self._square, jacobian)
        return self._next

    def advance_to(self, count: int) -> None:
        """Advance to the state after `count` steps; TooWideError if a ball is not finite."""
        while self.done < count:
            self.z, jacobian = self.look_ahead()
            change = jacobian.det() - 1
            self.squares += change * change
            # Λ = Π (1 + ΔJ_k) − 1 by the recurrence Λ ← Λ + ΔJ + Λ ΔJ: forming the product first
            # would lose the digits of a small Λ.
            self.lam += change + self.lam * change
            self.largest = self.largest.max(self._greatest_defect(jacobian))
            # The chain rule: the newest Jacobian stands on the left.
            self.matrix = jacobian * self.matrix
            self.done, self._next = self.done + 1, None
            if not _finite(self.z):
                raise TooWideError

    def _greatest_defect(self, jacobian: flint.arb_mat) -> Number:
        entries = defect(jacobian.entries(), self.field.degrees).values()
        return reduce(flint.arb.max, map(abs, entries), flint.arb(0))

    def values(self) -> dict[str, Number]:
        """Return the state, and what is computed from it, by the names of their columns."""
        values = dict(zip(self.field.names, self.z, strict=True)) | {
            "lambda": self.lam,
            "mse": self.squares / max(self.done, 1),
            "symplectic_defect_max": self.largest,
            "symplectic_defect": self._greatest_defect(self.matrix),
        }
        after, jacobian = self.look_ahead()
        extra = {"energy": self.field.energy(self.z, self.t)}
        if _finite(after):
            extra["delta_j"] = jacobian.det() - 1
        return values | {name: x for name, x in extra.items() if x.is_finite()}


def _finite(z: Vector) -> bool:
    return all(x.is_finite() for x in z)


# -- the exact flow -------------------------------------------------------------------------------

_MORE = 8  # digits, and orders, of the second integration
_MOST_STEPS = 5_000
_BURST, _STOPPED = 40, 60  # |z| above its first size, and steps below the first, in powers of two


class NoSolutionError(Exception):
    """The solution could not be followed; the message says why."""


class BlowsUpError(NoSolutionError):
    """The solution grows beyond every bound before the last of the times."""


def states_at(
    field: TextbookField, start: Mapping[str, Fraction], times: Sequence[Fraction], digits: int
) -> tuple[list[Vector], NoSolutionError | None]:
    """Return balls of z at the times, which ascend from 0, and the reason if some were not reached.

    `start`: the coordinates and, where H depends on it, t.
    """
    bits = math.ceil(3.33 * (digits + _MORE)) + 64
    with flint.ctx.workprec(bits):
        # Another tolerance and another order: an error of the method would have to be the same in
        # both to go unseen.
        rough, reason = _taylor_solution(field, start, times, digits)
        fine, fine_reason = _taylor_solution(field, start, times, digits + _MORE)
        states = [_merge(*pair, digits) for pair in zip(rough, fine, strict=False)]
        return states, reason or fine_reason


def _merge(rough: Vector, fine: Vector, digits: int) -> Vector:
    distance = max((abs(a - b).upper() for a, b in zip(rough, fine, strict=True)), key=_log_size)
    scale = max((abs(x).upper() for x in fine), key=_log_size)
    # An estimate, not a bound: the factor 4 and the term of 10^(−digits − 2) allow for errors that
    # both integrations share.
    radius = 4 * distance + scale * flint.arb(10) ** (-digits - 2)
    return [x.mid() + flint.arb(0, 1) * radius for x in fine]


def _taylor_solution(
    field: TextbookField, start: Mapping[str, Fraction], times: Sequence[Fraction], digits: int
) -> tuple[list[Vector], NoSolutionError | None]:
    order = digits + digits // 4 + 10
    z: Vector = [flint.arb(number(start[name])) for name in field.names]
    first_size, done, states = _largest_log(z), Fraction(0), []
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
        if _largest_log(z) > first_size + _BURST and reach < shortest - _STOPPED:
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
