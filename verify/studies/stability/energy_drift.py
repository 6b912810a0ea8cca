"""The drift of a bounded run: its energy moves on in one direction, however much it swings.

The run is cut into eight stretches of equal length. A drift is a mean energy that moves in one
direction from each to the next, by more in all than the means are uncertain; and that still does so
in a run four times as long, so that no slow beat is taken for one.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import ceil, sqrt
from statistics import fmean, pstdev

from verify.arithmetic.exact import quotient
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import MOST_INTERPRETED, MOST_SECTIONS, Trail, follow_precisely

_STRETCHES = 8
_LONGER = 4
_PERIODS = 8  # of the exact orbit, that the longer run lasts at least
_SEEN = 2.0**-53  # of the energy scale: what float64 could not show is no drift
_MOST_LOOKED_AT = 20_000  # steps of a last period
_FEW = 16  # of them, in which a run that goes on moves farther than one that has died
_SURE = 4.0  # standard errors of a mean
_SLOWER = 16.0  # times less, at most, in the longer run


def find_drift(motion: RunMotion) -> Fraction | None:
    """Return the energy's change in a unit of time, in parts of its scale; None for no drift.

    For a motion in the plane that has died away within the time it is the change over all of it.
    """
    run, trail, orbit = motion.run, motion.precise, motion.orbit
    if orbit.kind == "driven" or orbit.period is None or is_too_short(motion):
        return None
    errors = _energy_errors(motion, trail)
    closes = not orbit.has_neighbours
    if closes and errors and errors[-1] and has_died(motion, trail, orbit.period):
        return Fraction(errors[-1] / float(run.time))
    first = _drift_rate(errors, trail)
    if first is None:
        return None
    longer = motion.run.with_steps(_LONGER * trail.steps)
    if longer.steps <= MOST_INTERPRETED:
        again = follow_precisely(longer, motion.digits)
        if motion.stays(again):  # else it has drifted away
            second = _drift_rate(_energy_errors(motion, again), again)
            if second is None or second / first < 1 / _SLOWER:
                return None
    return Fraction(first)


def is_too_short(motion: RunMotion) -> bool:
    """Return True if the energy has swung too few times to distinguish a swing from a drift.

    Of an orbit that does not come back within the time there is only that one way.
    """
    orbit = motion.orbit
    if orbit.period is None:
        return orbit.kind == "open"
    return _LONGER * motion.precise.steps * motion.run.step_size < _PERIODS * orbit.period


def has_died(motion: RunMotion, trail: Trail, period: Fraction) -> bool:
    """Return True if the run ends by moving at most a hundredth of the exact orbit's reach.

    The end is followed step by step, since a trail may meet a periodic orbit at one point of it
    only.
    """
    steps = max(2, min(_MOST_LOOKED_AT, ceil(period / motion.run.step_size)))
    # A few steps decide most runs; they are among those of the full check.
    lengths = (_FEW, steps) if _FEW < steps <= MOST_SECTIONS else (steps,)
    return all(is_at_rest(motion, trail.onwards(trail.point(-1), n)) for n in lengths)


def is_at_rest(motion: RunMotion, trail: Trail) -> bool:
    """Return True if no coordinate moves by a hundredth of the exact orbit's reach."""
    orbit = motion.orbit
    swings = zip(trail.columns, orbit.reach, orbit.turns, strict=True)
    ends = ((quotient(min(x)), quotient(max(x)), r) for x, r, turns in swings if not turns)
    return all(high - low < r / 100 for low, high, r in ends)


def _energy_errors(motion: RunMotion, trail: Trail) -> list[float]:
    """Return (H − H(z₀)) / scale at the trail's points; empty where it is not known."""
    errors = motion.energy_errors(trail)
    values = [float(x) for x in errors if x is not None]
    return values if motion.orbit.scale and len(values) == len(errors) else []


def _drift_rate(errors: Sequence[float], trail: Trail) -> float | None:
    """Return the rate of the energy errors at a trail's points; None where no drift is seen."""
    if len(errors) < 4 * _STRETCHES:
        return None
    length = len(errors) // _STRETCHES
    parts = [errors[k * length : (k + 1) * length] for k in range(_STRETCHES)]
    means = [fmean(part) for part in parts]
    steps = [b - a for a, b in pairwise(means)]
    change = means[-1] - means[0]
    # A drift is monotone over all stretches; a swing turns round in some of them.
    if not (all(s > 0 for s in steps) or all(s < 0 for s in steps)) or abs(change) < _SEEN:
        return None
    if abs(change) < _SURE * _standard_error(errors, length):
        return None
    stretch = length * trail.every * float(trail.run.step_size)
    return float(change / (stretch * (_STRETCHES - 1)))


def _standard_error(errors: Sequence[float], count: int) -> float:
    """Return the standard error of a mean of so many errors.

    Second differences show the noise without the trend: of independent noise of variance s² their
    variance is (1 + 4 + 1) s², which is the 6 under the root.
    """
    bends = [a - 2 * b + c for a, b, c in zip(errors, errors[1:], errors[2:], strict=False)]
    return pstdev(bends) / sqrt(6 * count)
