"""The defect S = JᵀΩJ − Ω of the symplectic form at the places, compared with its noise.

S counts as 0 only up to the noise of the numbers in which the code computes, measured at each
place, or up to the defect that the user allows.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from itertools import pairwise

from verify.integrators.measures.distances import STEP_DIVISORS
from verify.integrators.measures.error_powers import Row, find_stretches
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.sides import Sides, other_sides
from verify.integrators.places.trial_places import USER, TrialPlace, select_spread
from verify.integrators.user_code.step import StepError, describe_error, unless_it_fails
from verify.integrators.user_code.user_map import UserMap

REFUTING_RATIO = 4.0  # an entry of S is not 0 if it exceeds its noise by more than this factor
# The noise of entries of S, in units in which those of Ω are 1. With more than the first, nothing
# is seen at a place; with more than the second, a map is not said to preserve anything.
MAX_BLUR = 1e-3
SHARP_BLUR = 1e-7
READING_DIVISORS = 1, 8  # S is read with a place's largest step size divided by each
_MAX_LADDER_PLACES = 3  # places at which S is followed as h falls
# S jumps if a smaller step has a defect larger by this factor: with a power of h it would fall.
_JUMP_FACTOR = 1.5


@dataclass(frozen=True)
class StructureMeasurement:
    """The measurement of S at all places.

    `how`: the kind of probe. `readings`: all that show anything; `blind`: those in which the noise
    of the probe hides S. `ladder`: the places at which S is followed as h falls; `rows` and
    `counts`, for each of them: the defects with their noise, and the numbers of comparisons.
    `failures`: the messages of calls that failed. `sides`: the comparisons of the code.
    """

    how: str
    readings: tuple[DefectReading, ...]
    blind: tuple[DefectReading, ...] = ()
    ladder: tuple[TrialPlace, ...] = ()
    rows: tuple[tuple[Row, ...], ...] = ()
    counts: tuple[tuple[int, ...], ...] = ()
    failures: tuple[str, ...] = ()
    sides: Sides = field(default_factory=lambda: Sides(()))

    @property
    def worst(self) -> DefectReading:
        """The reading in which an entry has the largest ratio to its noise."""
        return max(self.readings, key=lambda reading: reading.beyond)

    @property
    def largest(self) -> DefectReading:
        """The reading of the largest defect in units of its place, among those that refute S ≡ 0 if
        any do."""
        clear = [x for x in self.readings if x.beyond > REFUTING_RATIO]
        return max(clear or self.readings, key=lambda reading: reading.defect)

    @property
    def noise(self) -> float:
        """The largest noise of the readings, in units of their places."""
        return max(reading.blur for reading in self.readings)

    def is_kept(self, within: Fraction | None = None) -> bool | None:
        """Return True if S is 0 up to the noise, or up to the allowed defect `within`; None if the
        noise is too large to tell."""
        if within is not None:
            allowed_defect, readings = float(within), self.readings
            if any(x.defect - x.blur > allowed_defect for x in readings):
                return False
            return all(max(x.defect, x.blur) <= allowed_defect for x in readings) or None
        return self._vanishes(self.worst.beyond)

    @property
    def volume_kept(self) -> bool | None:
        """True if det J − 1 is 0 up to the noise; None if the noise is too large to tell."""
        return self._vanishes(max(abs(x.volume) / x.volume_noise for x in self.readings))

    def _vanishes(self, ratio: float) -> bool | None:
        """Return True if a defect with this ratio to its noise is 0; None if the noise hides it."""
        if ratio > REFUTING_RATIO:
            return False
        # A ratio that is no number fails both comparisons.
        return True if ratio <= REFUTING_RATIO and self.noise <= SHARP_BLUR else None

    @property
    def power(self) -> int | None:
        """The power of h by which S falls; None if it has not settled at every place where S is
        seen."""
        slopes = [find_stretches(rows) for rows in self.rows]
        # The power is that of the smallest step sizes, where the leading term dominates.
        # If a loop iterates, the later stretches may show its tolerance: the first one counts.
        last = 0 if self.iterates else -1
        powers = [x.runs[last].power for x in slopes if x.runs]
        clear = [x for x in slopes if x.is_seen]
        return min(powers) if powers and len(powers) == len(clear) and not self.jumps else None

    @property
    def jumps(self) -> bool:
        """True if S grows as h falls, as it does if a loop does one iteration less."""
        for rows in self.rows:
            clear = [(h, x) for h, x, noise in rows if x > REFUTING_RATIO * noise]
            if any(b > _JUMP_FACTOR * a for (_, a), (_, b) in pairwise(clear[1:])):
                return True
        return False

    @property
    def iterates(self) -> bool:
        """True if the number of comparisons differs from step size to step size."""
        return any(len(set(counts)) > 1 for counts in self.counts)


def structure_of(step: UserMap, probe: Probe, places: Sequence[TrialPlace]) -> StructureMeasurement:
    """Measure S at all of the places, and on the sides of comparisons that these do not reach.

    Raises StepError if there is no reading, or if all of them are blind.
    """
    sides, readings, failures = Sides(step.names), list[DefectReading](), list[str]()
    _read_places(probe, places, readings, sides, failures)
    if isinstance(probe, DualProbe) and readings:
        farthest = farthest_of(step, places)
        _read_places(probe, other_sides(probe, sides, farthest), readings, sides, failures)
    if not readings:
        raise StepError(failures[0] if failures else "it fails at all places")
    # If at least half of the readings are sharp, the others are left out; otherwise all count in
    # which anything can be seen. A defect that exceeds its noise always counts.
    sharp = sum(x.blur <= SHARP_BLUR for x in readings)
    blur_limit = SHARP_BLUR if 2 * sharp >= len(readings) else MAX_BLUR
    blind = tuple(x for x in readings if x.blur > blur_limit and x.beyond <= REFUTING_RATIO)
    seen_readings = tuple(x for x in readings if x not in blind)
    if not seen_readings:
        smallest, blur_limit = min(x.blur for x in blind), max(x.blur for x in blind)
        problem = (
            f"the probe sees nothing: its own error is `{smallest:.1e}` to `{blur_limit:.1e}` "
            "at the places"
        )
        raise StepError(problem)
    ladder = ladder_places(places) if step.takes_step_size else []
    rows, counts = _follow_defect(step, probe, ladder)
    return StructureMeasurement(
        probe.how, seen_readings, blind, tuple(ladder), rows, counts, tuple(failures), sides
    )


def _read_places(
    probe: Probe,
    places: Sequence[TrialPlace],
    readings: list[DefectReading],
    sides: Sides,
    failures: list[str],
) -> None:
    """Append the readings at the places, their comparisons, and the messages of failed calls."""
    for place in places:
        for divisor in READING_DIVISORS if place.step else READING_DIVISORS[:1]:
            if probe.step.seconds_left <= 0:
                return
            h = place.step / divisor
            try:
                readings.append(probe.reading(place, h))
                sides.note(place, h, probe.comparisons)
            except Exception as error:  # the user's code may raise anything
                call = probe.step.describe_call(place.z, h)
                failures.append(f"{describe_error(error)}{call}")


def farthest_of(step: UserMap, places: Sequence[TrialPlace]) -> dict[str, float]:
    """Return the largest |coordinate| up to which other sides are looked for: 100 units, or as far
    as 1,000 steps lead."""
    farthest = {
        name: 100.0 * max(max(float(x.units[k]), abs(float(x.z[k]))) for x in places)
        for k, name in enumerate(step.names)
    }
    for place in places[:2]:
        state, h, t = [float(x) for x in place.z], float(place.step), float(place.t)
        try:
            for k in range(1000):
                state = list(step.evaluate(state, h, t + k * h if step.time_dependent else t))
                for name, x in zip(step.names, state, strict=True):
                    farthest[name] = max(farthest[name], abs(x))
                if max(map(abs, state)) > 1e12 * max(map(float, place.units)):
                    break
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return farthest


def ladder_places(places: Sequence[TrialPlace]) -> list[TrialPlace]:
    """Select a few places, the user's among them, and one in each other scale."""
    of_user = [x for x in places if x.source == USER]
    others = [x for x in places if x.source != USER]
    by_units = {x.units: x for x in reversed(others)}  # the first of each
    spread = select_spread([x for x in others if x.units == others[0].units], _MAX_LADDER_PLACES)
    return [*of_user, *spread, *(x for u, x in by_units.items() if u != others[0].units)]


def _follow_defect(
    step: UserMap, probe: Probe, places: Sequence[TrialPlace]
) -> tuple[tuple[tuple[Row, ...], ...], tuple[tuple[int, ...], ...]]:
    """Measure S as h falls, and count the comparisons of the code; one result for each place."""
    all_rows, all_counts = [], []
    for place in places:
        rows, counts = list[Row](), list[int]()
        for divisor in STEP_DIVISORS:
            h = place.step / divisor
            if step.seconds_left <= 0:
                break
            reading = unless_it_fails(partial(probe.reading, place, h))
            if reading is not None:
                rows.append((float(h), reading.defect, reading.blur))
                counts.append(len(probe.comparisons))
        all_rows.append(tuple(rows))
        all_counts.append(tuple(counts))
    return tuple(all_rows), tuple(all_counts)
