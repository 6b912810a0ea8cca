"""The search for an exact orbit by the flow with few digits: see `verify.flows.exact_orbit`."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Literal

from verify.arithmetic.systems import mpfr
from verify.flows.closed_orbit import shifts
from verify.flows.compiled_functions import functions_at
from verify.flows.extrapolation import NoFlowError, Number, NumericalFlow, State
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, read_prose

_DIGITS, _MOST_DIGITS = 20, 40
_MOST_STEPS, _MOST_IN_TIME = 3000, 20_000
_STEP_ANGLE = Fraction(2, 5)  # radians; ω times the longest step: 16 points on a circle
_ESCAPE_FACTOR = 10**6  # units of |z₀|; an orbit farther out is leaving
_RETURN_TOLERANCE = Fraction(1, 5)  # reaches; a crossing nearer to z₀ is a return
# The first step is at most T/8; where T is 9 such steps or more, T does not decide it.
_FIRST_STEPS, _ROUNDING_MARGIN = 9, 1 + Fraction(1, 2**20)
_MAX_HALVINGS = 1100  # they lead from any step size of float64's range to any other
_BLOW_UP_FACTOR = 10**9  # longest step over the present one; a larger ratio is a blow-up
_STILL_FACTOR = 10**12  # a reach below |coordinate|/_STILL_FACTOR is replaced by |coordinate|
_OUTWARD_STEPS = 30  # consecutive outward steps that an orbit must make to be leaving
_OMEGA_DIGITS = 20

Coordinates = tuple[Fraction, ...]  # p, q; p1 … pn, q1 … qn
Kind = Literal[
    "closed", "rotates", "at rest", "open", "driven", "bounded", "escapes", "unknown",
    "not followed",
]  # fmt: skip


@dataclass(frozen=True)
class ExactOrbit:
    """The facts about the orbit through z₀ over a time T.

    `kind`: closed, closed up to a period of H (rotates), at rest, still under way at T (open),
    followed to its end where H depends on time (driven), leaves every bound (escapes), or not
    followed to its end (unknown); `verify.studies.stability` adds "bounded" and "not followed".
    `centre`, `reach`: the middle and the half-width of each coordinate's range. `turns`: True for
    each coordinate in which H is periodic and the orbit goes round, so that it has no bound there.
    `scale`: by about how much H changes across the orbit. `stiffness`: the greatest ω² =
    det Hess H on the orbit. `period`: that of a closed orbit, roughly. `more_digits`: the digits
    that were added because z₀ has more than ordinary numbers have. `has_neighbours`: True if it is
    followed beside neighbours, which show how fast they part, instead of until it closes.
    """

    kind: Kind
    summary: Prose
    centre: Coordinates
    reach: Coordinates
    turns: tuple[bool, ...]
    scale: Fraction
    stiffness: Fraction = Fraction(0)
    period: Fraction | None = None
    more_digits: int = 0
    has_neighbours: ClassVar[bool] = False

    @property
    def frequency(self) -> Fraction:
        """The greatest ω on the orbit, to some 20 digits; 0 where nothing oscillates."""
        if self.stiffness <= 0:
            return Fraction(0)
        arithmetic = mpfr.make(_OMEGA_DIGITS)
        with arithmetic.context():
            omega = arithmetic.functions["sqrt"](arithmetic.number(self.stiffness))
        return arithmetic.exact(omega)


class OrbitSearch:
    """A search that follows the flow from z₀ until it closes, leaves, or the time is over."""

    def __init__(
        self, hamiltonian: Hamiltonian, start: Coordinates, time: Fraction, t0: Fraction
    ) -> None:
        field, _ = canonical_field(hamiltonian)
        (force, speed), diff = field.slopes, field.ring.diff
        ring = field.ring
        h_pp, h_pq = diff(speed, "p"), diff(speed, "q")
        # det Hess H = H_pp H_qq − H_pq², with force = −H_q and speed = H_p.
        stiffness = ring.reduce(-h_pp * diff(force, "q") - h_pq * h_pq)
        self.more_digits = _initial_value_digits(start)
        self.flow = NumericalFlow(field, _DIGITS + self.more_digits)
        self.arithmetic = self.flow.arithmetic
        elements = [(ring, x) for x in (force, speed, stiffness, field.energy)]
        self.evaluate_at = functions_at(self.arithmetic, elements, self.flow.names)
        self.start, self.time, self.timed = start, self.number(time), field.timed
        self.z0: State = tuple(map(self.number, (*start, t0)[: len(self.flow.names)]))
        self.shifts = [self.shift_in_radians(s) for s in shifts(hamiltonian)]
        self.free = tuple(x.is_zero() for x in (speed, force))  # whether q, p stay as they are
        self.points: list[State] = [self.z0]
        self.rates: list[tuple[Number, Number, Number]] = []  # f and ω² at the points
        # The least time that gives the same orbit, if it closes by steps that the end never cuts.
        self.least_time: Fraction | None = None

    def shift_in_radians(self, shift: tuple[Fraction, Fraction]) -> State:
        """Convert a shift from units of 2π."""
        with self.arithmetic.context():
            turn = 2 * self.arithmetic.functions["pi"]
            return turn * self.number(shift[0]), turn * self.number(shift[1])

    def number(self, x: Fraction) -> Number:
        return self.arithmetic.number(x)

    def find_orbit(self) -> ExactOrbit:
        try:
            self.record_rates(self.z0)
        except NoFlowError as error:
            return self.build_orbit("unknown", error.reason)
        if not self.timed and not any(self.rates[0][:2]):
            return self.build_orbit("at rest", "stays where it is, an equilibrium")
        if not self.timed and any(self.free):
            moving, still = ("p", "q") if self.free[0] else ("q", "p")
            summary = f"H does not depend on {moving}: {still} stays and {moving} moves evenly"
            return self.build_orbit("rotates", summary, self.free)
        try:
            return self.integrate()
        except NoFlowError as error:
            return self.build_orbit("unknown", error.reason)

    def record_rates(self, z: State) -> None:
        """Record f and ω² at a point of the orbit; NoFlowError if they are not defined."""
        try:
            with self.arithmetic.context():
                dp, dq, stiffness, _ = self.evaluate_at(*z)  # H too must be defined at z
        except (ArithmeticError, ValueError):
            raise NoFlowError("H or its derivatives are not defined there") from None
        self.rates.append((dp, dq, stiffness))

    def integrate(self) -> ExactOrbit:
        with self.arithmetic.context():
            z, time, step = self.z0, self.time - self.time, self.time / 16
        outwards, longest, cut, least = 0, None, False, time
        for k in range(_MOST_IN_TIME if self.timed else _MOST_STEPS):
            with self.arithmetic.context():
                remaining, limit = self.time - time, self.largest_step()
                # Steps at most double: one bad guess cannot jump over a fast stretch.
                candidate = min(2 * step, limit)
                cut = cut or candidate >= remaining or (k == 0 and candidate < limit)
                least = max(least, time + candidate, _FIRST_STEPS * candidate if k == 0 else least)
                step = min(candidate, remaining)
            step, after = self.take_step(z, step)
            if after is None or (longest and step < remaining and step * _BLOW_UP_FACTOR < longest):
                summary = f"becomes ever faster at t = `{self.clock(time):.6g}`"
                return self.build_orbit("escapes", summary)
            with self.arithmetic.context():
                time = time + step
                longest = max(longest or step, step)
                grown = self.size(after)
                outwards = outwards + 1 if grown > self.size(z) else 0
            self.points.append(after)
            self.record_rates(after)
            if grown > _ESCAPE_FACTOR and outwards >= _OUTWARD_STEPS:
                summary = (
                    f"is `{_ESCAPE_FACTOR:.0e}` times as far out as z0 at "
                    f"t = `{self.clock(time):.6g}`, and goes on"
                )
                return self.build_orbit("escapes", summary)
            crossing = None if self.timed else self.find_return(z, after)
            if crossing is not None:
                shift, part = crossing
                with self.arithmetic.context():
                    period = time - (1 - part) * step
                if not cut:
                    self.least_time = self.arithmetic.exact(least) * _ROUNDING_MARGIN
                kind: Kind = "rotates" if any(shift) else "closed"
                summary = f"{kind}, with a period of about `{float(period):.3g}`"
                return self.build_orbit(kind, summary, shift, period=self.arithmetic.exact(period))
            z = after
            if time >= self.time:
                end = f"t = `{self.clock(time):.6g}`"
                if self.timed:
                    return self.build_orbit("driven", f"is driven; followed to its end, {end}")
                return self.build_orbit("open", f"is still under way at {end}")
        return self.build_orbit("unknown", f"was followed to t = `{self.clock(time):.6g}` only")

    def clock(self, time: Number) -> float:
        """Return the value of t at `time` after the start."""
        return float(time) + (float(self.z0[2]) if self.timed else 0)

    def largest_step(self) -> Number:
        """Return the step that the local frequency allows; call it inside the context."""
        stiffness = abs(self.rates[-1][2])
        if stiffness == 0:
            return self.time
        return self.number(_STEP_ANGLE) / self.arithmetic.functions["sqrt"](stiffness)

    def take_step(self, z: State, step: Number) -> tuple[Number, State | None]:
        """Return the longest of step, step/2, … that is accurate, and the state after it."""
        for _ in range(_MAX_HALVINGS):
            after = self.flow.step(z, step)
            if after is not None:
                return step, after
            with self.arithmetic.context():
                step = step / 2
        return step, None

    def size(self, z: State) -> Number:
        """Return |z|/|z₀| (if z₀ = 0: z₁) in the maximum norm; call it inside the context."""
        near = (self.z0, self.points[min(1, len(self.points) - 1)])
        first, second = (max(map(abs, x[:2])) for x in near)
        return max(map(abs, z[:2])) / (first or second) if first or second else first

    def find_return(self, z: State, after: State) -> tuple[State, Number] | None:
        """Return the shift of a return in the step from z, and the part of the step before it.

        None if the step crossed no line through a z₀ + shift near to that point.
        """
        with self.arithmetic.context():
            reach = self._ends()[1]
            # The first steps are still near z₀: a crossing there is no return.
            if len(self.points) < 4 or not all(reach):
                return None
            for shift in self.shifts:
                target = (self.z0[0] + shift[0], self.z0[1] + shift[1])
                part = self._find_crossing(z, after, target, reach)
                if part is not None:
                    return shift, part
        return None

    def _find_crossing(self, z: State, after: State, target: State, reach: State) -> Number | None:
        """Return the part of the chord from z to `after` that lies before the target's line.

        The line goes through the target, normal to f(z₀) in units of the reach. None if the chord
        does not cross it near the target.
        """
        slope = [r / x for r, x in zip(self.rates[0][:2], reach, strict=True)]

        def height(point: State) -> Number:
            return sum(
                s * (x - t) / r for s, x, t, r in zip(slope, point, target, reach, strict=True)
            )

        low, high = height(z), height(after)
        if not low < 0 <= high:
            return None
        part = -low / (high - low)
        crossing = [x + part * (y - x) for x, y in zip(z, after, strict=True)]
        near = all(
            abs(x - t) < self.number(_RETURN_TOLERANCE) * r
            for x, t, r in zip(crossing, target, reach, strict=True)
        )
        return part if near else None

    def _ends(self) -> tuple[State, State]:
        """Return the middle of the points so far, and their half-width, in p and q."""
        ends = [(min(x), max(x)) for x in list(zip(*self.points, strict=True))[:2]]
        middle = tuple((low + high) / 2 for low, high in ends)
        return middle, tuple((high - low) / 2 for low, high in ends)

    def build_orbit(
        self,
        kind: Kind,
        summary: str,
        shift: Sequence[Number] = (0, 0),
        period: Fraction | None = None,
    ) -> ExactOrbit:
        to_fraction, zero = self.arithmetic.exact, self.number(Fraction(0))
        with self.arithmetic.context():
            centre, half_widths = self._ends()
            fastest = [max((abs(r[k]) for r in self.rates), default=zero) for k in (0, 1)]
            stiffest = max((r[2] for r in self.rates), default=zero)
        # A coordinate that has hardly moved in that time is measured by its own size.
        reach = tuple(
            to_fraction(r) if to_fraction(r) > abs(x) / _STILL_FACTOR else abs(x)
            for r, x in zip(half_widths, self.start, strict=True)
        )
        # H_p = q' and H_q = −p', each at its greatest on the orbit.
        scale = (to_fraction(fastest[1]) * reach[0] + to_fraction(fastest[0]) * reach[1]) / 2
        return ExactOrbit(
            kind=kind,
            summary=read_prose(summary),
            centre=tuple(map(to_fraction, centre)),
            reach=reach,
            turns=self.find_turns(half_widths, shift),
            scale=scale,
            stiffness=to_fraction(stiffest),
            period=period,
            more_digits=self.more_digits,
        )

    def find_turns(self, half_widths: State, shift: Sequence[Number]) -> tuple[bool, ...]:
        """Return, for each coordinate, True if the orbit goes round in it.

        It does so in the coordinates of its shift; where H depends on time, in those in which it
        has gone further than a period of H.
        """
        if not self.timed:
            return tuple(map(bool, shift))
        farthest = enumerate(half_widths)
        return tuple(any(2 * x > abs(s[k]) > 0 for s in self.shifts) for k, x in farthest)


def _initial_value_digits(start: Coordinates) -> int:
    """Return the number of digits of an initial value, beyond those of ordinary numbers."""
    digits = max(len(str(x.numerator).rstrip("0")) for x in start)
    return min(digits, _MOST_DIGITS) if digits > _DIGITS else 0
