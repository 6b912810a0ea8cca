"""A user's step measured: its Jacobian and its distance from the exact flow, for a ladder of steps.

With dual numbers of 200 bits where its code lets them through; else with floats, the Jacobian by
central differences of the sixth order, whose error is estimated by a second width.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from verify.flows.extrapolation import Flow, NoFlowError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.fitted_order import Fitted, fitted
from verify.integrators.number_type import DOUBLE, NumberType
from verify.integrators.step import Step, StepError
from verify.integrators.step_probes import MORE, PROBES, End, Point, Probe
from verify.integrators.wrapped import Periods, unwrapped, wrapped

_DIGITS = {"duals": 50}
LADDERS = {
    "duals": [Fraction(1, 2**k) for k in range(2, 25)],
    "floats": [
        *(Fraction(x, 2**k) for k in range(2, 11) for x in (4, 3)),
        *(Fraction(1, 2**k) for k in range(9, 23)),  # where an order is low
    ],
}
# To show where an order is missed: what is small beside the rest shows at small steps.
FINER = {"duals": [Fraction(1, 2**k) for k in range(3, 61)], "floats": LADDERS["floats"]}
_RISES = 1.5  # times the ΔJ of a larger step: no power of h does so
_FINE = (
    0.25  # the largest step at which that is looked for: further terms may do so for larger ones
)
_ENOUGH = 6  # rows, with which what is slow may end


@dataclass(frozen=True)
class Trial:
    """A step, the H that it is for, and the points at which it is tried."""

    step: Step
    hamiltonian: Hamiltonian
    points: Sequence[Point]


@dataclass(frozen=True)
class Reading:
    """At one point with one step: ΔJ, and the distance from the exact flow, with their noise."""

    delta_j: float
    delta_noise: float
    error: float
    error_noise: float
    increment: float  # of the exact flow


@dataclass(frozen=True)
class Row:
    """The largest readings of one step size: ΔJ and the distance, each with its point."""

    h: Fraction
    delta_j: float
    delta_noise: float
    delta_at: Point
    error: float
    error_noise: float
    error_at: Point
    increment: float


@dataclass(frozen=True)
class Measured:
    """`how`: "duals" or "floats". `rows` by falling h. `opaque`: whether it may solve equations up
    to a tolerance, since values were compared or floats hide what it does. `rounded`: whether its
    coefficients are. `points`: those that it was tried at, and `times`: t at each, where H depends
    on it. `periods`: modulo which it was compared with the flow.
    """

    how: str
    rows: tuple[Row, ...]
    opaque: bool
    rounded: bool
    points: tuple[Point, ...]
    times: tuple[Fraction, ...] = ()
    numbers: str = "floats"  # what the step's own are called
    periods: Periods = ()

    @property
    def steady(self) -> tuple[Row, ...]:
        """The rows down to where ΔJ first grows as h falls, as where a loop does one turn less."""
        told = [k for k, row in enumerate(self.rows) if abs(row.delta_j) > 10 * row.delta_noise]
        for k, after in pairwise(told):
            one, two = self.rows[k], self.rows[after]
            if one.h <= _FINE and abs(two.delta_j) > _RISES * abs(one.delta_j):
                return self.rows[:after]
        return self.rows

    @property
    def ragged(self) -> bool:
        """Whether ΔJ is like what the tolerance of a loop leaves, and follows no power before."""
        return self.opaque and self.area.power is None and len(self.steady) < len(self.rows)

    @property
    def area(self) -> Fitted:
        used = self.steady if self.opaque else self.rows
        rows = [(float(r.h), abs(r.delta_j), r.delta_noise) for r in used]
        # Two steps of the same tolerance may differ by a power, by chance; five hardly do.
        return fitted(rows, self.opaque, 5 if self.how == "floats" else 3)

    @property
    def distance(self) -> Fitted:
        rows = [(float(r.h), r.error, r.error_noise) for r in self.rows]
        return fitted(rows, self.opaque)

    @property
    def largest(self) -> Row:
        """The row of the largest |ΔJ|, of those that are ten times their noise where there are."""
        told = [row for row in self.rows if abs(row.delta_j) > 10 * row.delta_noise]
        return max(told or self.rows, key=lambda row: abs(row.delta_j))

    @property
    def noise(self) -> float:
        """The largest noise of ΔJ: the probe's own error."""
        return max(row.delta_noise for row in self.rows)

    @property
    def unseen(self) -> float:
        """An error of the step's increments, in parts of them, that would not show at any h."""
        seen = [(r.error + 10 * r.error_noise) / r.increment for r in self.rows if r.increment]
        return min(seen, default=math.inf)


def measured(trial: Trial, how: str, ladder: Sequence[Fraction] = ()) -> Measured:
    """All readings, with the steps of `ladder`, falling, or those of `LADDERS[how]`.

    Raises StepError, or what the user's code raises, where there are too few.
    """
    ladder, step = ladder or LADDERS[how], trial.step
    flow, probe = flow_of(trial.hamiltonian, how, step.numbers), PROBES[how](step)
    rows, lost = [], ""
    step.periods = wrapped(_ends(trial, probe, flow, ladder[-1]), trial.hamiltonian, ladder[-1])

    def at(point: Point, h: Fraction) -> Reading | None:
        nonlocal lost
        try:
            return reading(probe, flow, point, h)
        except Exception as error:  # the user's code may raise anything
            lost = f"{error}, at p = {point[0]}, q = {point[1]}, h = {h}"
            return None

    # A point at which no step can be made is left out, and so is a step that is too large for one.
    alive = [point for point in trial.points if at(point, ladder[-1]) is not None]
    for h in ladder if alive else ():
        found = {point: at(point, h) for point in alive}
        readings = {point: each for point, each in found.items() if each is not None}
        if step.left <= 0:
            break
        if len(readings) == len(alive):
            rows.append(_row(h, readings))
    if len(rows) < _ENOUGH:
        raise StepError(lost or "it fails for most steps")
    times = tuple(step.clock(*point) for point in alive) if step.moving else ()
    numbers = "floats" if step.numbers is DOUBLE else step.numbers.declared_as
    return Measured(
        how, tuple(rows), probe.opaque, probe.rounded, tuple(alive), times, numbers, step.periods
    )


def _ends(trial: Trial, probe: Probe, flow: Flow, h: Fraction) -> list[tuple[End, End]]:
    """The step's and the flow's, from the points where there are both."""
    found = []
    for point in trial.points:
        try:
            found.append((probe.end(point, h)[0], _goal(probe, flow, point, h)[1]))
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return found


def flow_of(hamiltonian: Hamiltonian, how: str, numbers: NumberType) -> Flow:
    """The exact flow, to the digits that a reading asks for."""
    return Flow(hamiltonian.field()[0], _DIGITS.get(how, numbers.digits + MORE))


def _row(h: Fraction, readings: dict[Point, Reading]) -> Row:
    area = max(readings, key=lambda point: abs(readings[point].delta_j))
    distance = max(readings, key=lambda point: readings[point].error)
    return Row(
        h,
        readings[area].delta_j,
        max(r.delta_noise for r in readings.values()),
        area,
        readings[distance].error,
        max(r.error_noise for r in readings.values()),
        distance,
        max(r.increment for r in readings.values()),
    )


def reading(probe: Probe, flow: Flow, point: Point, h: Fraction) -> Reading:
    """ΔJ of one step, and its distance from that flow, of an H with the step's t or without."""
    end, delta, delta_noise, noise = probe.at(point, h)
    error, increment = _from_flow(probe, flow, point, h, end)
    return Reading(delta, delta_noise, error, noise, increment)


def distance(probe: Probe, flow: Flow, point: Point, h: Fraction) -> tuple[float, float]:
    """Of one step from that flow, and its noise: a reading without ΔJ, which takes most calls."""
    end, noise = probe.end(point, h)
    return _from_flow(probe, flow, point, h, end)[0], noise


def _from_flow(
    probe: Probe, flow: Flow, point: Point, h: Fraction, state: End
) -> tuple[float, float]:
    """How far the state is from the flow's, and how far the flow goes."""
    start, end = _goal(probe, flow, point, h)
    with flow.arithmetic.context():
        periods = probe.step.periods or (Fraction(0),) * 2
        here = [unwrapped(x, y, each) for x, y, each in zip(state, end, periods, strict=True)]
        away = max(abs(float(x - y)) for x, y in zip(here, end, strict=True))
        increment = max(abs(float(end[0] - start[0])), abs(float(end[1] - start[1])))
    return away, increment


def _goal(probe: Probe, flow: Flow, point: Point, h: Fraction) -> tuple[End, End]:
    """Where the flow begins and ends."""
    clock = (probe.step.clock(*point),) if flow.timed else ()
    start = tuple(map(flow.number, (*point, *clock)))
    try:
        end = flow.advance(start, flow.number(h))
    except NoFlowError as error:
        raise StepError(error.said) from None
    return (start[0], start[1]), (end[0], end[1])
