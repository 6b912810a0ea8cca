"""Whose fault is it, in n degrees of freedom? One run of one scheme, judged.

As in the plane (`verify.studies.stability.verdict_on_run`) the exact motion, the scheme in high
precision and in float64 are held against one another. Where float64 parts from the scheme in high
precision, the motion may be sensitive, chaotic or near an unstable orbit, and then no scheme is to
blame, and no arithmetic:

- the exact motion parts from its neighbours exponentially: `sensitive`;
- it does not, and the scheme's own map does, in high precision: `unstable: scheme`;
- neither does: `unstable: arithmetic`;
- where the time does not tell: `undecided`.

Bounds: ten times the exact motion's reach, and a hundred times its energy scale, but for an H that
depends on time. A run that leaves them in high precision is `unstable: scheme`; of a sensitive
motion only where it has lost its energy before: one that keeps it, and leaves, is `sensitive`.
"""

from fractions import Fraction
from functools import cached_property

from verify.arithmetic.exact import fraction
from verify.flows.energies import energies_at
from verify.prose import prose, read_prose
from verify.studies.stability.energy_drift import LONGER, SLOWER, rate_of
from verify.studies.stability.exact_motion import (
    ExactMotion,
    Sensitivity,
    distance,
    exact_motion,
    moved,
)
from verify.studies.stability.run_motion import float64
from verify.studies.stability.trail import (
    MOST_INTERPRETED,
    Point,
    RunInDegrees,
    Trail,
    first_apart,
    first_step,
    follow,
    follow_precisely,
)
from verify.studies.stability.verdict_on_run import Judgement

_BEYOND, _ENERGY, _APART = 10, 100, 0.1
_DIGITS = 40
_NEAR = Fraction(1, 10**20)  # of the reach, a neighbour of the scheme's own orbit
_KEPT = 1  # energy scales: what has not lost more has kept its energy
_PERIODS = 8  # that a run lasts at least, for a drift to be told from a swing


class MotionInDegrees:
    """What is seen of one run; each thing is made when it is looked at."""

    def __init__(self, run: RunInDegrees, orbit: ExactMotion | None = None) -> None:
        """`orbit`: the exact motion from there, over the run's time or longer, if it is known."""
        self.run, self.digits = run, _DIGITS
        of = run.hamiltonian, run.state, run.time, run.t0
        self.orbit: ExactMotion = exact_motion(*of) if orbit is None else orbit

    @cached_property
    def precise(self) -> Trail:
        return follow_precisely(self.run, self.digits)

    @cached_property
    def float64(self) -> Trail:
        """For as many steps as were done in high precision."""
        return follow(self.run.shortened(self.precise.steps), float64())

    @cached_property
    def own(self) -> Sensitivity:
        """That of the scheme's own map, in high precision."""
        near = self.run.onwards(
            moved(self.run.state, self.orbit.reach, _NEAR), 0, self.precise.steps
        )
        other, h = follow_precisely(near, self.digits), float(self.run.step_size)
        pairs = list(zip(self.precise.points, other.points, strict=False))
        apart = [distance(a.state, b.state, self.orbit.reach) for a, b in pairs]
        return Sensitivity.of([a.step * h for a, _ in pairs], apart)

    def _energy(self, point: Point) -> Fraction | None:
        (found,) = energies_at(self.run.hamiltonian, 2 * self.digits, [[x] for x in point.state])
        return None if found is None else fraction(found)

    @cached_property
    def _first_energy(self) -> Fraction | None:
        return self._energy(Point(0, self.run.state))

    def energy_error(self, point: Point) -> Fraction | None:
        """H − H(z₀) in parts of the orbit's scale; 0 where H depends on time."""
        if self.run.hamiltonian.time_dependent:
            return Fraction(0)
        first, here = self._first_energy, self._energy(point)
        return None if first is None or here is None else (here - first) / self.orbit.scale

    def energy_errors(self, trail: Trail) -> list[Fraction | None]:
        return [self.energy_error(point) for point in trail.points]

    def worst(self, trail: Trail) -> Fraction | None:
        """The greatest energy error seen in a run, in size; None where H depends on time."""
        if self.run.hamiltonian.time_dependent:
            return None
        return max((abs(x) for x in self.energy_errors(trail) if x is not None), default=None)

    def beyond(self, point: Point) -> bool:
        orbit = self.orbit
        places = zip(point.state, orbit.centre, orbit.reach, strict=True)
        if any(abs(x - c) > _BEYOND * r for x, c, r in places):
            return True
        error = self.energy_error(point)
        return error is None or abs(error) > _ENERGY

    def stays(self, trail: Trail) -> bool:
        return trail.finished and not any(map(self.beyond, trail.points))

    def apart(self, one: Point, other: Point) -> bool:
        return distance(one.state, other.state, self.orbit.reach) > _APART

    def together(self, one: Trail, other: Trail) -> bool:
        pairs = zip(one.points, other.points, strict=True)
        return one.finished and other.finished and not any(self.apart(*x) for x in pairs)


def judge_in_degrees(motion: MotionInDegrees) -> Judgement:
    """The verdict on one run."""
    orbit = motion.orbit
    if orbit.kind == "escapes":
        return Judgement("escapes", prose("the exact solution ", orbit.summary))
    if orbit.kind == "unknown":
        unknown = "the exact solution, to be held against, is not known: "
        return Judgement("undecided", prose(unknown, orbit.summary))
    if not motion.stays(motion.precise):
        return _leaves(motion)
    if motion.together(motion.float64, motion.precise):
        return _bounded(motion)
    return _parts(motion)


def _sensitive(motion: MotionInDegrees) -> bool | None:
    seen = motion.orbit.sensitivity
    return None if seen is None else seen.exponential


def _leaves(motion: MotionInDegrees) -> Judgement:
    digits = 2 * motion.digits
    again = follow_precisely(motion.run, digits)
    step = first_step(again, motion.beyond)
    if step is None:
        told = prose(f"{motion.digits} and {digits} digits differ in whether the orbit stays")
        return Judgement("undecided", told)
    before = [x for x in again.points if x.step < step]
    errors = [motion.energy_error(x) for x in before]
    worst = max((abs(x) for x in errors if x is not None), default=Fraction(0))
    where = f"leaves the bounds at step {step}, in {motion.digits} and in {digits} digits"
    if _sensitive(motion) and worst <= _KEPT:
        told = prose(
            f"the scheme {where}, its energy kept; the exact solution ", motion.orbit.summary
        )
        return Judgement("sensitive", told, step=step, energy_error=worst)
    return Judgement("unstable: scheme", prose(f"the scheme {where}"), step=step)


def _parts(motion: MotionInDegrees) -> Judgement:
    """float64 is elsewhere than the scheme in high precision."""
    step = first_apart(motion.float64, motion.precise, motion.apart)
    at = f"at step {step}" if step is not None else f"before step {motion.float64.done + 1}"
    told = prose(f"float64 parts {at} from the same scheme in {motion.digits} digits")
    worst = motion.worst(motion.precise)
    exact = prose("; the exact solution ", motion.orbit.summary)
    if _sensitive(motion):
        return Judgement("sensitive", told + exact, step=step, energy_error=worst)
    if _sensitive(motion) is None:
        return Judgement("undecided", told + exact, step=step, energy_error=worst)
    if motion.own.exponential:
        rate = read_prose(
            f"; so do neighbours of its own orbit (`{motion.own.exponent:.2g}` in a unit of time)"
        )
        return Judgement("unstable: scheme", told + rate + exact, step=step, energy_error=worst)
    return Judgement("unstable: arithmetic", told + exact, step=step, energy_error=worst)


def _bounded(motion: MotionInDegrees) -> Judgement:
    precise, run = motion.precise, motion.run
    told = prose(f"bounded over all {run.steps} steps")
    if precise.steps < run.steps:
        told = prose(f"bounded over the {precise.steps} steps that were done in high precision")
    told += prose("; the exact solution ", motion.orbit.summary)
    rate = _drift(motion)
    worst = motion.worst(precise)
    return Judgement("stable" if rate is None else "drifts", told, rate=rate, energy_error=worst)


def _drift(motion: MotionInDegrees) -> Fraction | None:
    """As in the plane: in one direction, and still so in a run four times as long."""
    run, orbit = motion.run, motion.orbit
    if orbit.kind == "driven" or orbit.period is None:
        return None
    if LONGER * motion.precise.steps * run.step_size < _PERIODS * orbit.period:
        return None
    first = _rate(motion, motion.precise)
    longer = run.shortened(LONGER * motion.precise.steps)
    if first is None or longer.steps > MOST_INTERPRETED:
        return None if first is None else Fraction(first)
    again = follow_precisely(longer, motion.digits)
    if motion.stays(again):  # else it has drifted away
        second = _rate(motion, again)
        if second is None or second / first < 1 / SLOWER:
            return None
    return Fraction(first)


def _rate(motion: MotionInDegrees, trail: Trail) -> float | None:
    errors = motion.energy_errors(trail)
    known = [float(x) for x in errors if x is not None]
    return rate_of(known, trail) if len(known) == len(errors) else None
