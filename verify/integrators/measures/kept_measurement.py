"""The defects of structures, measured at places and as h falls, compared with their noise."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial

from verify.integrators.measures.distances import LADDERS
from verify.integrators.measures.error_powers import find_stretches, settle_power
from verify.integrators.measures.kept_readings import CLEAR_RATIO, FollowedDefect, KeptReading
from verify.integrators.measures.measured_values import MeasuredValues, components_of
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.measures.sides import Line, Sides, other_sides
from verify.integrators.measures.structure_measurement import (
    MAX_BLUR,
    READING_DIVISORS,
    REFUTING_RATIO,
    SHARP_BLUR,
    farthest_of,
    ladder_places,
)
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.wrap_periods import Periods
from verify.integrators.user_code.step import StepError, describe_error, unless_it_fails
from verify.structures import Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

# Divisors of the step size, by the kind of the probe; and the number of readings in the noise after
# which no smaller step sizes are tried.
_LADDERS = {"duals": LADDERS["duals"], "floats": LADDERS["floats"]}
_MOST_JACOBIANS = 18  # step sizes at which J is measured by floats, which takes many calls
_QUIET_RATIO, _MOST_QUIET = 10.0, 3
# The divisor at which the other places are compared with those that are followed: a term of a lower
# power exceeds all others there. A defect is larger if it is so by this factor.
_SMALL, _LARGER = {"duals": Fraction(2) ** 18, "floats": Fraction(2) ** 9}, 4
_LOOSE = 0.5  # the last slopes of a place where none has settled may be so much below the power
_MIN_COMPARISONS_OF_LOOP = 4  # in one line of code, in one call
_SLOPE_TOLERANCE = 0.2  # slopes may be so much below the power that is claimed


@dataclass(frozen=True)
class KeptMeasurement:
    """The measurement of one structure.

    `ladder`: the readings at a few places, as h falls at each; `counts`: the comparisons of the
    code in each of them. `iterates`: True if the code has a loop that ends by a comparison.
    """

    structure: Structure
    how: str
    readings: tuple[KeptReading, ...]
    ladder: tuple[tuple[KeptReading, ...], ...] = ()
    counts: tuple[tuple[int, ...], ...] = ()
    iterates: bool = False

    @property
    def seen(self) -> list[KeptReading]:
        """The readings in which something can be seen."""
        sharp = [x for x in self.readings if x.row[2] <= SHARP_BLUR]
        limit = SHARP_BLUR if 2 * len(sharp) >= len(self.readings) else MAX_BLUR
        return [x for x in self.readings if x.row[2] <= limit or x.ratio > CLEAR_RATIO]

    @property
    def largest(self) -> KeptReading | None:
        """The reading of the largest defect, among those clear of their noise if any are."""
        clear = [x for x in self.seen if x.ratio > CLEAR_RATIO]
        readings = clear or self.seen
        return max(readings, key=lambda x: x.largest[1].defect) if readings else None

    @property
    def vanishes(self) -> bool | None:
        """True if the defect is 0 up to the noise; None if the noise may hide or explain it."""
        readings = self.seen
        if not readings:
            return None
        ratio = max(x.ratio for x in readings)
        if ratio > CLEAR_RATIO:
            return False
        sharp = all(x.row[2] <= SHARP_BLUR for x in readings)
        return True if ratio <= REFUTING_RATIO and sharp else None

    def is_within(self, allowed: float) -> bool | None:
        """Return True if the defect is at most `allowed`, in natural units; None if that is not
        seen."""
        rows = [x.row for x in self.readings]
        if any(defect - noise > allowed for _, defect, noise in rows):
            return False
        return (bool(rows) and all(max(x, e) <= allowed for _, x, e in rows)) or None

    @cached_property
    def _powers(self) -> list[FollowedDefect]:
        """The powers of h at the places at which the defect is seen as h falls."""
        follows = []
        for readings, counts in zip(self.ladder, self.counts, strict=True):
            rows = [x.row for x in readings]
            stretches = find_stretches(rows)
            if stretches.is_seen and rows[0][0]:  # a map has no h
                moved = [float(x.h / x.place.step) for x in readings]
                power = settle_power(stretches, rows, counts, moved, self.how, 1.0)
                follows.append(FollowedDefect(readings, counts, stretches.unsettled, power))
        return follows

    @property
    def _telling(self) -> list[FollowedDefect]:
        """The places at which the power is seen: elsewhere the defect is smaller than at those,
        down to its noise, as where terms cancel."""
        settled = [x for x in self._powers if x.power.power is not None and x.power.tail is None]
        largest = dict[Fraction, float]()
        for x in settled:
            largest |= {n: max(y, largest.get(n, 0.0)) for n, y in x.sizes.items()}
        return [x for x in self._powers if x in settled or x.exceeds(largest)]

    @property
    def _is_of_loop(self) -> bool:
        return self.iterates and any(x.jumps for x in self._powers)

    @property
    def power(self) -> int | None:
        """The power of h by which the defect falls; None if it has not settled wherever it is
        seen."""
        powers = [x.power.power for x in self._telling if x.power.power is not None]
        if not powers or self._is_of_loop:
            return None
        # At a place where terms cancel the slopes may not have settled; they must not be lower.
        loose = [x.unsettled[-2:] for x in self._telling if x.power.power is None]
        settled = all(min(x, default=0.0) > min(powers) - _LOOSE for x in loose)
        return min(powers) if settled else None

    def falls_as(self, power: int) -> bool:
        """Return True if the defect falls as h^power or faster, to the smallest step sizes at which
        it is seen; not so where a loop ends early, or a lower term is small."""
        slowest = min((x.slowest for x in self._telling), default=0.0)
        return slowest > power - _SLOPE_TOLERANCE and not self._is_of_loop


class KeptSurvey:
    """The measurement of several structures at the same places, by one probe.

    The values of a step are shared. `periods`: of the coordinates, by which a way back is reduced.
    """

    def __init__(self, probe: Probe, places: Sequence[TrialPlace], periods: Periods = ()) -> None:
        self.probe, self.places, self.periods = probe, places, periods
        self._values: dict[tuple[TrialPlace, Fraction], MeasuredValues] = {}
        self._failure = ""

    def measure(self, structure: Structure) -> KeptMeasurement:
        """Measure a structure at all of the places; as h falls, where its defect is not 0.

        Raises StepError if it can be read at no place.
        """
        # Beyond a comparison the code may be another system's, of other integrals.
        is_integral = isinstance(structure, FirstIntegral)
        everywhere = self.places if is_integral else [*self.places, *self._sides]
        self._failure = ""
        pairs = [(x, x.step / k) for x in everywhere for k in _divisors(x)]
        readings = [x for place, h in pairs if (x := self.read(structure, place, h))]
        if not readings:
            raise StepError(self._failure or "it fails at all places")
        flat = KeptMeasurement(structure, self.probe.how, tuple(readings))
        return flat if flat.vanishes else self._follow(flat)

    def read(
        self, structure: Structure, place: TrialPlace, h: Fraction, *, sharp: bool = False
    ) -> KeptReading | None:
        """Return the reading; None if the code fails, or a formula is not defined.

        `sharp`: without the noise of doubles, and the step is called even if its values are at
        hand.
        """
        if self.probe.step.seconds_left <= 0:
            return None
        values = self._values.get((place, h))
        if values is None or sharp:
            values = MeasuredValues(self.probe, place, h, self.periods, sharp=sharp)
        if not sharp:
            self._values[place, h] = values
        try:
            return KeptReading(place, h, components_of(structure, values))
        except Exception as error:  # the user's code may raise anything
            call = self.probe.step.describe_call(place.z, h)
            self._failure = self._failure or f"{describe_error(error)}{call}"
            return None

    def _follow(self, flat: KeptMeasurement) -> KeptMeasurement:
        """Return the measurement with the defects as h falls, and what the code's loops tell."""
        ladder, lines = list[tuple[list[KeptReading], list[int]]](), Counter[Line]()
        places = ladder_places(self.places)
        ladder += [self._follow_at(flat, x, lines) for x in places]
        other = self._find_larger(flat, ladder, [x for x in self.places if x not in places])
        ladder += [self._follow_at(flat, other, lines)] if other else []
        loops = any(n >= _MIN_COMPARISONS_OF_LOOP for n in lines.values())
        iterates = loops or any(len(set(x)) > 1 for _, x in ladder)
        return replace(flat, ladder=tuple(tuple(x) for x, _ in ladder),
                       counts=tuple(tuple(x) for _, x in ladder), iterates=iterates)  # fmt: skip

    def _follow_at(
        self, flat: KeptMeasurement, place: TrialPlace, lines: Counter[Line]
    ) -> tuple[list[KeptReading], list[int]]:
        """Return the readings at a place as h falls, and the numbers of comparisons; add the most
        comparisons of a line to `lines`."""
        divisors = _LADDERS[flat.how]
        if not isinstance(flat.structure, FirstIntegral | Reversible | Symmetric):
            divisors = divisors[:_MOST_JACOBIANS]
        readings, numbers, quiet = list[KeptReading](), list[int](), 0
        for divisor in divisors if place.step else divisors[:1]:
            reading = self.read(flat.structure, place, place.step / divisor, sharp=True)
            if reading is not None:
                readings.append(reading)
                numbers.append(len(self.probe.comparisons))
                lines |= Counter(x.line for x in self.probe.comparisons)
                quiet = quiet + 1 if reading.ratio <= _QUIET_RATIO else 0
            if quiet >= _MOST_QUIET:
                break
        return readings, numbers

    def _find_larger(
        self, flat: KeptMeasurement, ladder: Sequence[tuple[list[KeptReading], list[int]]],
        places: Sequence[TrialPlace],
    ) -> TrialPlace | None:  # fmt: skip
        """Return the place at which the defect is the largest at a small h, if it is larger than at
        those in `ladder`, as where a branch of the code has another term; else None."""
        divisor = _SMALL[flat.how]
        followed = (x.row[1] for readings, _ in ladder for x in readings
                    if x.h * divisor == x.place.step and x.ratio > CLEAR_RATIO)  # fmt: skip
        most, result = _LARGER * max(followed, default=0.0), None
        for place in places if any(x.step for x in places) else ():
            reading = self.read(flat.structure, place, place.step / divisor, sharp=True)
            if reading is not None and reading.ratio > CLEAR_RATIO and reading.row[1] > most:
                most, result = reading.row[1], place
        return result

    @cached_property
    def _sides(self) -> list[TrialPlace]:
        """Places on the sides of comparisons in the code that the others do not reach."""
        probe = self.probe
        if not isinstance(probe, DualProbe) or not probe.opaque:
            return []
        sides = Sides(probe.step.names)
        for place in self.places:
            for divisor in _divisors(place):
                h = place.step / divisor
                if unless_it_fails(partial(probe.jacobian, place, h)) is not None:
                    sides.note(place, h, probe.comparisons)
        return other_sides(probe, sides, farthest_of(probe.step, self.places))


def _divisors(place: TrialPlace) -> Sequence[int]:
    return READING_DIVISORS if place.step else READING_DIVISORS[:1]
