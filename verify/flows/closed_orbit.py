"""The closed orbits of the exact flow, with their periods.

An orbit is closed where it comes back to its initial value z₀ (a libration), or to z₀ shifted by a
period of H in p or q (a rotation, as the pendulum's). No other orbit is taken for closed:
NoFlowError, with its reason, is raised for one on a separatrix and for one that leaves.

The flow is followed with 16 digits until it crosses, in the direction of f(z₀), the line through z₀
normal to f(z₀), at z₀ itself. Newton's method then refines the period at the full precision, and
checks that the orbit closes to all digits. One on a separatrix does not close, as the number of
digits decides how near it comes to the saddle; one close to a separatrix is tried with 15 and 30
digits more.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Literal

import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.limits import substitute
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.flows.compiled_functions import functions_at
from verify.flows.extrapolation import LOST, NoFlowError, Number, NumericalFlow, State
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import period_in

Element = tuple[Ring, Poly]
Start = tuple[Fraction, Fraction]  # p, q
Shift = tuple[Fraction, Fraction]  # of p and q, in units of 2π

_SEARCH_DIGITS = 16  # the digits of the flow that looks for the first return
_EXTRA_DIGITS = (0, 15, 30)  # tried in turn, as an orbit near a separatrix loses digits
_MOST_STEPS = 2000
_ESCAPE_FACTOR = 10**4  # the reach, in sizes of z₀ and its shifts, beyond which the search ends
_RETURN_TOLERANCE = 1e-7  # the distance from z₀ that counts as 0, in parts of the orbit's reach
_TURN_COSINES = (0.5, 0.95)  # a step turns by less than 60°; after one of under 18° it is doubled
_MAX_HALVINGS, _BISECTIONS, _NEWTON_STEPS = 100, 6, 8


@dataclass(frozen=True)
class ClosedOrbit:
    """The closed orbit through z₀ at the M equally spaced times k P / M.

    `period` is P, or None for an equilibrium, which has one point. `shift`: z(P) − z₀, not zero for
    a rotation. `flow` is the exact flow at the precision of the points.
    """

    flow: NumericalFlow
    points: tuple[State, ...]
    period: Number | None
    shift: State

    @property
    def kind(self) -> Literal["libration", "rotation", "equilibrium"]:
        if self.period is None:
            return "equilibrium"
        return "rotation" if any(self.shift) else "libration"

    def values(self, element: Element) -> list[Number]:
        """Evaluate a function of p and q at the points.

        Raises NoFlowError if it is not defined.
        """
        function = functions_at(self.flow.arithmetic, [element])
        try:
            with self.flow.arithmetic.context():
                return [function(*z)[0] for z in self.points]
        except (ArithmeticError, ValueError):
            raise NoFlowError("the function is not defined along the whole orbit") from None

    def finer(self) -> "ClosedOrbit":
        """Return the orbit with one more point halfway between each two. Raises NoFlowError."""
        time = self.time(Fraction(1, 2 * len(self.points)))
        between = [self.flow.advance(z, time) for z in self.points]
        points = tuple(z for pair in zip(self.points, between, strict=True) for z in pair)
        return ClosedOrbit(self.flow, points, self.period, self.shift)

    def time(self, part: Fraction) -> Number:
        """Return the period times `part`."""
        assert self.period is not None  # noqa: S101 - an equilibrium has none
        with self.flow.arithmetic.context():
            return self.period * self.flow.number(part)


def closed_orbit(hamiltonian: Hamiltonian, start: Start, digits: int, count: int) -> ClosedOrbit:
    """Return the orbit through z₀ = (p, q) at `count` times. Raises NoFlowError if not closed."""
    hamiltonian.check_planar()
    field, _ = canonical_field(hamiltonian)
    if is_equilibrium(hamiltonian, field, start):
        flow = NumericalFlow(field, digits)
        zero = flow.number(Fraction(0))
        p, q = (flow.number(x) for x in start)
        return ClosedOrbit(flow, ((p, q),), None, (zero, zero))
    first_return = _first_return(hamiltonian, start)
    for more in _EXTRA_DIGITS:
        orbit = _refine_period(
            NumericalFlow(field, digits + more), start, first_return, digits, count
        )
        if orbit is not None:
            return orbit
    raise NoFlowError(
        "no closed orbit: what seemed to be one does not close with more digits, "
        "as it lies on a separatrix or very near to one"
    )


def is_equilibrium(hamiltonian: Hamiltonian, field: CanonicalField, start: Start) -> bool:
    """Return True if z₀ is an equilibrium, by algebra; NoFlowError if that does not decide."""
    ring = field.ring
    numbers = (sympy.Rational(x.numerator, x.denominator) for x in start)
    point = dict(zip((symbol("p"), symbol("q")), numbers, strict=True))
    slopes = [ring.expression(x) for x in field.slopes]
    try:
        _, *slope_values = [substitute(x, point, "z0") for x in (hamiltonian.exact, *slopes)]
        constants, elements = embed(slope_values, ())
    except (InputError, ArithmeticError):
        raise NoFlowError("H is not defined at the initial value, or too large there") from None
    zero = [constants.decide(x).zero for x in elements]
    if None in zero and False not in zero:
        raise NoFlowError("whether the initial value is an equilibrium is not decided")
    return False not in zero


def shifts(hamiltonian: Hamiltonian) -> Iterator[Shift]:
    """Yield (0, 0) and ± the periods of H in p and in q, in units of 2π."""
    zero = Fraction(0)
    yield zero, zero
    for name in ("p", "q"):
        turns = (period_in(hamiltonian, name) or sympy.S.Zero) / (2 * sympy.pi)
        if turns.is_Rational and turns:
            period = Fraction(int(turns.p), int(turns.q))
            for size in (period, -period):
                yield (size, zero) if name == "p" else (zero, size)


# -- the first return -----------------------------------------------------------------------------


@dataclass(frozen=True)
class _Return:
    """The first return to z₀ + `shift` (in units of 2π), after about `time`.

    `reach`: the greatest distance of the orbit from z₀.
    """

    time: float
    shift: Shift
    reach: float


@lru_cache(maxsize=8)
def _first_return(hamiltonian: Hamiltonian, start: Start) -> _Return:
    # An average asks for the same orbit at least twice, each time with more digits.
    rough = NumericalFlow(canonical_field(hamiltonian)[0], _SEARCH_DIGITS)
    return _ReturnSearch(rough, start, list(shifts(hamiltonian))).find_return()


class _ReturnSearch:
    """A search that follows the flow from z₀ until it returns."""

    def __init__(self, flow: NumericalFlow, start: Start, shifts: list[Shift]) -> None:
        self.flow = flow
        self.z0: State = flow.number(start[0]), flow.number(start[1])
        self.f0 = flow.slope(self.z0)
        self.targets = [(shift, _shift_state(flow, self.z0, shift)) for shift in shifts]
        self.reach = 0.0

    def find_return(self) -> _Return:
        z, time = self.z0, 0.0
        span = 1 + max(_distance(target, (0, 0)) for _, target in self.targets)
        step = span / _distance(self.f0, (0, 0)) / 16
        for _ in range(_MOST_STEPS):
            step, after, cosine = self.take_step(z, step)
            self.reach = max(self.reach, _distance(after, self.z0))
            crossings = [self.find_crossing(z, step, after, target) for target in self.targets]
            if any(crossings):
                first, shift = min(crossing for crossing in crossings if crossing)
                return _Return(time + first, shift, self.reach)
            if self.reach > _ESCAPE_FACTOR * span:
                raise NoFlowError("the orbit is not closed: it goes far away")
            z, time = after, time + step
            step *= 2 if cosine > _TURN_COSINES[1] else 1
        raise NoFlowError(f"the orbit is not seen to close until t = `{time:.3g}`")

    def take_step(self, z: State, step: float) -> tuple[float, State, float]:
        """Return the longest of step, step/2, … that is accurate and turns by less than 60°.

        Returned with it: the state after it, and the cosine of the angle that f turns by.
        """
        before = self.flow.slope(z)
        for _ in range(_MAX_HALVINGS):
            after = self.flow.step(z, _exactly(self.flow, step))
            if after is not None:
                cosine = _cosine(before, self.flow.slope(after))
                if cosine > _TURN_COSINES[0]:
                    return step, after, cosine
            step /= 2
        raise NoFlowError(LOST)

    def height(self, z: State, target: State) -> float:
        """Return f(z₀) · (z − target): it is 0 on the line through the target normal to f(z₀)."""
        return float(self.f0[0] * (z[0] - target[0]) + self.f0[1] * (z[1] - target[1]))

    def find_crossing(
        self, z: State, step: float, after: State, goal: tuple[Shift, State]
    ) -> tuple[float, Shift] | None:
        """Return the time from z to the target, and its shift; None if the step misses it."""
        shift, target = goal
        if not self.height(z, target) < 0 <= self.height(after, target):
            return None
        low, high = 0.0, step
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            state = self.flow.advance(z, _exactly(self.flow, middle))
            low, high = (middle, high) if self.height(state, target) < 0 else (low, middle)
        # Newton's method for height(φ_time(z)) = 0, whose derivative in time is f(z₀) · f(z).
        time = high
        for _ in range(_NEWTON_STEPS):
            state = self.flow.advance(z, _exactly(self.flow, time))
            slope = self.flow.slope(state)
            rate = float(self.f0[0] * slope[0] + self.f0[1] * slope[1])
            if rate <= 0:
                return None
            time -= self.height(state, target) / rate
        near = max(self.reach, _distance(after, self.z0)) * _RETURN_TOLERANCE
        return (time, shift) if _distance(state, target) < near else None


# -- the period in full ---------------------------------------------------------------------------


def _refine_period(
    flow: NumericalFlow, start: Start, first_return: _Return, digits: int, count: int
) -> ClosedOrbit | None:
    """Return the orbit with its period to all digits; None if it does not close to `digits`."""
    z0: State = flow.number(start[0]), flow.number(start[1])
    target = _shift_state(flow, z0, first_return.shift)
    period, z = _exactly(flow, first_return.time), z0
    for _ in range(_pieces(count)):
        z = flow.advance(z, _part(flow, period, _pieces(count)))
    f0 = flow.slope(z0)
    # Near the period z(t) − target is about (t − P) f(z₀); its part along f(z₀) corrects the time.
    for _ in range(_NEWTON_STEPS):
        if _distance(z, target) > first_return.reach / 100:
            return None
        with flow.arithmetic.context():
            residual = f0[0] * (target[0] - z[0]) + f0[1] * (target[1] - z[1])
            change = residual / (f0[0] ** 2 + f0[1] ** 2)
            period = period + change
        if change:
            z = flow.advance(z, change)
    if _distance(z, target) * 10.0**digits > first_return.reach:
        return None
    points, time = [z0], _part(flow, period, count)
    for _ in range(count - 1):
        points.append(flow.advance(points[-1], time))
    with flow.arithmetic.context():
        shift = target[0] - z0[0], target[1] - z0[1]
    return ClosedOrbit(flow, tuple(points), period, shift)


def _pieces(count: int) -> int:
    return max(16, count)


def _part(flow: NumericalFlow, period: Number, count: int) -> Number:
    with flow.arithmetic.context():
        return period / count


def _shift_state(flow: NumericalFlow, z: State, shift: Shift) -> State:
    if not any(shift):
        return z
    turn = flow.arithmetic.functions["pi"]
    with flow.arithmetic.context():
        p, q = (x + 2 * turn * flow.number(s) for x, s in zip(z, shift, strict=True))
    return p, q


def _exactly(flow: NumericalFlow, time: float) -> Number:
    return flow.number(Fraction(time))


def _distance(z: State, target: State) -> float:
    return math.hypot(float(z[0] - target[0]), float(z[1] - target[1]))


def _cosine(x: State, y: State) -> float:
    product = float(x[0] * y[0] + x[1] * y[1])
    size = _distance(x, (0, 0)) * _distance(y, (0, 0))
    return product / size if size else 0.0
