"""The motion in one run, in float64 and in high precision: its bounds, and a drift.

A run keeps within its bounds if each coordinate stays within ten times the exact orbit's reach of
its centre, and |H − H(z₀)| within a hundred times the orbit's energy scale (see
`verify.studies.stability.exact_motion`). The second is not required if H depends on time, as the
drive changes its value. Two runs are apart if they differ by more than a tenth of the reach.

The energy of a bounded run drifts if it moves on in one direction, however much it swings. The run
is cut into eight stretches of equal length. A drift is a mean energy that moves in one direction
from each stretch to the next, in all by at least four standard errors of a mean. It must continue
in a run four times as long, so that no slow beat is taken for a drift.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, sqrt
from operator import sub
from statistics import fmean, pstdev
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic.exact import fraction, quotient
from verify.arithmetic.number_system import Arithmetic
from verify.flows.compiled_functions import energies_at
from verify.flows.orbit_search import ExactOrbit
from verify.studies.stability.exact_motion import Sensitivity, displace, distance, exact_motion
from verify.studies.stability.trail import (
    MOST_INTERPRETED,
    MOST_SECTIONS,
    RunTrail,
    StabilityRun,
    TrailPoint,
    follow,
    follow_precisely,
)

_REACH_FACTOR = 10  # a run leaves its bounds beyond this many times the reach
_ENERGY_FACTOR = 100  # and beyond this many times the energy scale
_APART = Fraction(1, 10)  # relative to the reach
_DIGITS = 40
_NEIGHBOUR_DISTANCE = Fraction(1, 10**20)  # in the scheme's own sensitivity, relative to the reach
# Constants of a drift:
_STRETCHES = 8
_LENGTH_FACTOR = 4  # the longer run has this many times the steps
_LEAST_PERIODS = 8  # of the exact orbit's: the longer run lasts at least so long
_LEAST_DRIFT = 2.0**-53  # relative to the energy scale: float64 could not show less
_MAX_STEPS_AT_END = 20_000  # steps of the period in which a run is examined for rest
_FEW_STEPS = 16  # most runs that are not at rest show it in so many steps of that period
_STANDARD_ERRORS = 4.0  # the least drift, in standard errors of a mean
_MAX_SLOWDOWN = 16.0  # the rate in the longer run is at most this many times smaller


def float64() -> Arithmetic:
    """Return the arithmetic of float64."""
    return number_systems.get("float64", 17)


class RunMotion:
    """One run compared with the exact orbit; each of its trails is computed when it is needed."""

    def __init__(self, run: StabilityRun, orbit: ExactOrbit | None = None) -> None:
        """Compare with `orbit`, which lasts at least as long as the run; computed if left out."""
        self.run = run
        self.orbit = orbit or exact_motion(run.hamiltonian, run.state, run.time, run.t0)
        self.digits = _DIGITS + self.orbit.more_digits
        self._energy_cache: dict[int, tuple[RunTrail, list[Any]]] = {}

    @cached_property
    def float64(self) -> RunTrail:
        """The run in float64."""
        return follow(self.run, float64())

    @cached_property
    def precise(self) -> RunTrail:
        """The run with `digits` digits, for as many of its steps as `follow_precisely` does."""
        return follow_precisely(self.run, self.digits)

    @cached_property
    def float64_as_far(self) -> RunTrail:
        """The float64 run for as many steps as were done in high precision."""
        steps = self.precise.steps
        if steps == self.run.steps:
            return self.float64
        return follow(self.run.with_steps(steps), float64())

    @cached_property
    def sensitivity(self) -> Sensitivity:
        """The sensitivity of the scheme's own map, in high precision."""
        reach = self.orbit.reach
        neighbour_run = self.run.onwards(
            displace(self.run.state, reach, _NEIGHBOUR_DISTANCE), 0, self.precise.steps
        )
        neighbour, h = follow_precisely(neighbour_run, self.digits), float(self.run.step_size)
        pairs = list(zip(self.precise.points, neighbour.points, strict=False))
        distances = [distance(a.state, b.state, reach) for a, b in pairs]
        return Sensitivity.from_distances([a.step * h for a, _ in pairs], distances)

    @cached_property
    def _first_energy(self) -> Any:
        """The energy H(z₀); None if it is not defined or too large."""
        (energy,) = self._energies_at([[x] for x in self.run.state])
        return None if energy is None else quotient(energy)

    @cached_property
    def _scale(self) -> Any:
        return quotient(self.orbit.scale or 1)

    def _energies_at(self, columns: Sequence[Sequence[Any]]) -> list[Any]:
        return energies_at(self.run.hamiltonian, 2 * self.digits, columns)

    def _error(self, energy: Any) -> Any:
        """Return H − H(z₀) relative to the orbit's energy scale; None if either is not known."""
        if energy is None or self._first_energy is None:
            return None
        return (quotient(energy) - self._first_energy) / self._scale

    def _energies(self, trail: RunTrail) -> list[Any]:
        """Return H at a run's points, computed once; an empty list for a driven run."""
        if self.run.hamiltonian.time_dependent:
            return []
        if id(trail) not in self._energy_cache:
            self._energy_cache[id(trail)] = trail, self._energies_at(trail.columns)
        return self._energy_cache[id(trail)][1]

    def energy_errors(self, trail: RunTrail) -> list[Any]:
        """Return the energy errors at a run's points, as gmpy2's rationals.

        One is None if it is not known. The list is empty for a driven run.
        """
        return list(map(self._error, self._energies(trail)))

    def _extreme_errors(self, trail: RunTrail) -> list[Any]:
        """Return the least and the greatest energy error, and None if some are not known."""
        energies = self._energies(trail)
        values = [x for x in energies if x is not None]
        # Only the extremes of H are turned into errors: the error is monotone in H.
        ends: list[Any] = [self._error(end(values)) for end in (min, max)] if values else []
        return ends if len(values) == len(energies) else [*ends, None]

    def worst(self, trail: RunTrail) -> Fraction | None:
        """Return the greatest |energy error| of a run."""
        sizes = [abs(x) for x in self._extreme_errors(trail) if x is not None]
        return fraction(max(sizes)) if sizes else None

    @cached_property
    def _bounds(self) -> list[tuple[int, Any, Any]]:
        """The indices of the coordinates that have bounds, each with its lower and upper bound."""
        orbit = self.orbit
        triples = enumerate(zip(orbit.centre, orbit.reach, orbit.turns, strict=True))
        # An angle has no bound. A coordinate that does not move has reach 0, for which 1 stands.
        wide = [(k, c, _REACH_FACTOR * (r or 1)) for k, (c, r, turns) in triples if not turns]
        return [(k, quotient(centre - half), quotient(centre + half)) for k, centre, half in wide]

    def _is_inside(self, columns: Sequence[Sequence[Any]]) -> bool:
        """Return True if no coordinate of these states is out of its bounds."""
        bounds = ((columns[k], low, high) for k, low, high in self._bounds)
        return all(low <= min(x) and max(x) <= high for x, low, high in bounds)

    def is_outside(self, point: TrailPoint) -> bool:
        """Return True if a coordinate is out of its bounds."""
        return not self._is_inside([[x] for x in point.state])

    def is_beyond(self, point: TrailPoint) -> bool:
        """Return True if a coordinate or the energy is out of its bounds."""
        outside = self.is_outside(point)
        if outside or self.run.hamiltonian.time_dependent:
            return outside
        (energy,) = self._energies_at([[x] for x in point.state])
        return _is_too_large(self._error(energy))

    def stays(self, trail: RunTrail) -> bool:
        """Return True if a run finishes and keeps within the bounds, its energy included."""
        if not (trail.is_finished and self._is_inside(trail.columns)):
            return False
        return not any(map(_is_too_large, self._extreme_errors(trail)))

    @cached_property
    def _tolerances(self) -> list[Any]:
        """For each coordinate the greatest difference of two runs that are not apart."""
        return [quotient(_APART * (r or 1)) for r in self.orbit.reach]

    def are_apart(self, point: TrailPoint, other_point: TrailPoint) -> bool:
        """Return True if two states differ by more than a tenth of the reach in a coordinate."""
        pairs = zip(point.state, other_point.state, self._tolerances, strict=True)
        return any(abs(x - y) > tolerance for x, y, tolerance in pairs)

    def stay_together(self, trail: RunTrail, other_trail: RunTrail) -> bool:
        """Return True if two runs of as many steps both finish, and are together all the way."""
        columns = zip(trail.columns, other_trail.columns, self._tolerances, strict=True)
        return (
            trail.is_finished
            and other_trail.is_finished
            and all(_farthest(x, y) <= tolerance for x, y, tolerance in columns)
        )


def _farthest(xs: Sequence[Any], ys: Sequence[Any]) -> Any:
    """Return the greatest |x − y| of pairs of numbers."""
    return max(map(abs, map(sub, map(quotient, xs), map(quotient, ys))))


def _is_too_large(error: Any) -> bool:
    return error is None or abs(error) > _ENERGY_FACTOR


def find_drift(motion: RunMotion) -> Fraction | None:
    """Return the drift's rate: the change of energy/scale in a unit of time; None for no drift.

    For a motion in the plane that has come to rest within the time it is the mean over all of it.
    """
    run, trail, orbit = motion.run, motion.precise, motion.orbit
    if orbit.kind == "driven" or orbit.period is None or is_too_short(motion):
        return None
    errors = _energy_errors(motion, trail)
    closes = not orbit.has_neighbours
    if closes and errors and errors[-1] and has_died(motion, trail, orbit.period):
        return Fraction(errors[-1] / float(run.time))
    rate = _drift_rate(errors, trail)
    if rate is None:
        return None
    longer = motion.run.with_steps(_LENGTH_FACTOR * trail.steps)
    if longer.steps <= MOST_INTERPRETED:
        longer_trail = follow_precisely(longer, motion.digits)
        if motion.stays(longer_trail):  # a run that leaves its bounds has drifted away
            longer_rate = _drift_rate(_energy_errors(motion, longer_trail), longer_trail)
            if longer_rate is None or longer_rate / rate < 1 / _MAX_SLOWDOWN:
                return None
    return Fraction(rate)


def is_too_short(motion: RunMotion) -> bool:
    """Return True if the energy has swung too few times to distinguish a swing from a drift.

    An orbit that does not come back within the time, `open`, has not swung once.
    """
    orbit = motion.orbit
    if orbit.period is None:
        return orbit.kind == "open"
    return (
        _LENGTH_FACTOR * motion.precise.steps * motion.run.step_size < _LEAST_PERIODS * orbit.period
    )


def has_died(motion: RunMotion, trail: RunTrail, period: Fraction) -> bool:
    """Return True if the run, continued for a period, moves less than a hundredth of the reach.

    The period is followed step by step, since a trail may meet a periodic orbit always at the same
    point.
    """
    steps = max(2, min(_MAX_STEPS_AT_END, ceil(period / motion.run.step_size)))
    # A few steps decide most runs; the full check contains them.
    lengths = (_FEW_STEPS, steps) if _FEW_STEPS < steps <= MOST_SECTIONS else (steps,)
    return all(is_at_rest(motion, trail.onwards(trail.point(-1), n)) for n in lengths)


def is_at_rest(motion: RunMotion, trail: RunTrail) -> bool:
    """Return True if no coordinate moves by a hundredth of the exact orbit's reach."""
    orbit = motion.orbit
    swings = zip(trail.columns, orbit.reach, orbit.turns, strict=True)
    ends = ((quotient(min(x)), quotient(max(x)), r) for x, r, turns in swings if not turns)
    return all(high - low < r / 100 for low, high, r in ends)


def _energy_errors(motion: RunMotion, trail: RunTrail) -> list[float]:
    """Return (H − H(z₀)) / scale at the trail's points; empty if one of them is not known."""
    errors = motion.energy_errors(trail)
    values = [float(x) for x in errors if x is not None]
    return values if motion.orbit.scale and len(values) == len(errors) else []


def _drift_rate(errors: Sequence[float], trail: RunTrail) -> float | None:
    """Return the rate of the energy errors at a trail's points; None if no drift is seen."""
    if len(errors) < 4 * _STRETCHES:
        return None
    length = len(errors) // _STRETCHES
    parts = [errors[k * length : (k + 1) * length] for k in range(_STRETCHES)]
    means = [fmean(part) for part in parts]
    steps = [b - a for a, b in pairwise(means)]
    change = means[-1] - means[0]
    # A drift is monotone over all stretches; a swing turns round in some of them.
    if not (all(s > 0 for s in steps) or all(s < 0 for s in steps)) or abs(change) < _LEAST_DRIFT:
        return None
    if abs(change) < _STANDARD_ERRORS * _standard_error(errors, length):
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
