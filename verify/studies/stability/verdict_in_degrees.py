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
from verify.prose import prose, read_prose
from verify.studies.stability.energy_drift import lasting_rate, too_short
from verify.studies.stability.exact_motion import (
    ExactMotion,
    Sensitivity,
    distance,
    exact_motion,
    moved,
)
from verify.studies.stability.run_motion import Motion
from verify.studies.stability.trail import Run, first_apart, first_step, follow_precisely
from verify.studies.stability.verdict_on_run import Judgement

_NEAR = Fraction(1, 10**20)  # of the reach, a neighbour of the scheme's own orbit
_KEPT = 1  # energy scales: what has not lost more has kept its energy


class MotionInDegrees(Motion[ExactMotion]):
    """That in n degrees of freedom."""

    def __init__(self, run: Run, orbit: ExactMotion | None = None) -> None:
        """`orbit`: the exact motion from there, over the run's time or longer, if it is known."""
        of = run.hamiltonian, run.state, run.time, run.t0
        super().__init__(run, exact_motion(*of) if orbit is None else orbit)

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
    if motion.together(motion.as_far, motion.precise):
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
    errors = motion.energy_errors(again)[: sum(x.step < step for x in again.points)]
    worst = fraction(max((abs(x) for x in errors if x is not None), default=0))
    where = f"leaves the bounds at step {step}, in {motion.digits} and in {digits} digits"
    if _sensitive(motion) and worst <= _KEPT:
        told = prose(
            f"the scheme {where}, its energy kept; the exact solution ", motion.orbit.summary
        )
        return Judgement("sensitive", told, step=step, energy_error=worst)
    return Judgement("unstable: scheme", prose(f"the scheme {where}"), step=step)


def _parts(motion: MotionInDegrees) -> Judgement:
    """float64 is elsewhere than the scheme in high precision."""
    step = first_apart(motion.as_far, motion.precise, motion.apart)
    at = f"at step {step}" if step is not None else f"before step {motion.as_far.done + 1}"
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
    orbit = motion.orbit
    if orbit.kind == "driven" or orbit.period is None or too_short(motion):
        return None
    return lasting_rate(motion)
