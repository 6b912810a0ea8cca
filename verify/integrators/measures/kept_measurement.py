"""The defects of structures, measured at places and as h falls, compared with their noise.

Each component of a defect has a natural scale at its place, so that nothing depends on the units of
the coordinates.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

from verify.integrators.measures.distances import LADDERS
from verify.integrators.measures.error_powers import find_stretches, settle_power
from verify.integrators.measures.followed_defect import FollowedDefect
from verify.integrators.measures.measured_values import MeasuredValues, components_of
from verify.integrators.measures.measurement import (
    Measurement,
    farthest_of,
    ladder_places,
    read_places,
    sizes_at,
)
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.measures.reading import KeptReading
from verify.integrators.measures.sides import MIN_COMPARISONS_OF_LOOP, Line, Sides, other_sides
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.wrap_periods import Periods
from verify.integrators.user_code.step import StepError, describe_error
from verify.structures import Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

_MOST_JACOBIANS = 18  # step sizes at which J is measured by floats, which takes many calls
# After so many readings in the noise no smaller step sizes are tried.
_QUIET_RATIO, _MOST_QUIET = 10.0, 3
# The divisor at which the other places are compared with those that are followed: a term of a lower
# power exceeds all others there. A defect is larger if it is so by this factor.
_SMALL, _LARGER = {"duals": Fraction(2) ** 18, "floats": Fraction(2) ** 9}, 4
_LOOSE = 0.5  # the last slopes of a place where none has settled may be so much below the power
_SLOPE_TOLERANCE = 0.2  # slopes may be so much below the power that is claimed


@dataclass(frozen=True)
class KeptMeasurement(Measurement[KeptReading]):
    """The measurement of one structure."""

    structure: Structure = field(kw_only=True)

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
        self._values: dict[tuple[TrialPlace, Fraction, bool], MeasuredValues] = {}
        self._failure = ""

    def measure(self, structure: Structure) -> KeptMeasurement:
        """Measure a structure at all of the places; as h falls, where its defect is not 0.

        Raises StepError if it can be read at no place.
        """
        # Beyond a comparison the code may be another system's, of other integrals.
        is_integral = isinstance(structure, FirstIntegral)
        everywhere = self.places if is_integral else [*self.places, *self._sides]
        self._failure = ""
        pairs = [(x, h) for x in everywhere for h in sizes_at(x)]
        readings = [x for place, h in pairs if (x := self.read(structure, place, h))]
        if not readings:
            raise StepError(self._failure or "it fails at all places")
        flat = KeptMeasurement(self.probe.how, tuple(readings), structure=structure)
        if flat.vanishes:
            return flat
        divisors = LADDERS[flat.how]
        if not isinstance(structure, FirstIntegral | Reversible | Symmetric):
            divisors = divisors[:_MOST_JACOBIANS]
        places = ladder_places(self.places)
        followed = self.follow(structure, places, divisors)
        other = self._find_larger(followed, [x for x in self.places if x not in places])
        if other is not None:
            followed = self.follow(structure, [*places, other], divisors)
        return replace(followed, readings=flat.readings)

    def read(
        self, structure: Structure, place: TrialPlace, h: Fraction, *, sharp: bool = False
    ) -> KeptReading | None:
        """Return the reading; None if the code fails, or a formula is not defined.

        `sharp`: without the noise of doubles.
        """
        if self.probe.step.seconds_left <= 0:
            return None
        try:
            return KeptReading(place, h, components_of(structure, self._values_at(place, h, sharp)))
        except Exception as error:  # the user's code may raise anything
            call = self.probe.step.describe_call(place.z, h)
            self._failure = self._failure or f"{describe_error(error)}{call}"
            return None

    def _values_at(self, place: TrialPlace, h: Fraction, sharp: bool = False) -> MeasuredValues:
        key = place, h, sharp and self.probe.how == "duals"
        if key not in self._values:
            self._values[key] = MeasuredValues(self.probe, place, h, self.periods, sharp=sharp)
        return self._values[key]

    def follow(
        self, structure: Structure, places: Sequence[TrialPlace], divisors: Sequence[Fraction]
    ) -> KeptMeasurement:
        """Return the readings at some places as h falls, and what the code's loops tell."""
        ladder, counts = list[tuple[KeptReading, ...]](), list[tuple[int, ...]]()
        lines = Counter[Line]()
        for place in places:
            readings, numbers, quiet = list[KeptReading](), list[int](), 0
            for divisor in divisors if place.step else divisors[:1]:
                h = place.step / divisor
                reading = self.read(structure, place, h, sharp=True)
                if reading is not None:
                    comparisons = self._values_at(place, h, sharp=True).comparisons
                    readings.append(reading)
                    numbers.append(len(comparisons))
                    lines |= Counter(x.line for x in comparisons)
                    quiet = quiet + 1 if reading.ratio <= _QUIET_RATIO else 0
                if quiet >= _MOST_QUIET:
                    break
            ladder.append(tuple(readings))
            counts.append(tuple(numbers))
        loops = any(n >= MIN_COMPARISONS_OF_LOOP for n in lines.values())
        flat = tuple(x for readings in ladder for x in readings)
        return KeptMeasurement(
            self.probe.how, flat, tuple(ladder), tuple(counts), loops, structure=structure
        )

    def _find_larger(
        self, followed: KeptMeasurement, places: Sequence[TrialPlace]
    ) -> TrialPlace | None:
        """Return the place at which the defect is the largest at a small h, if it is larger than at
        those that are followed, as where a branch of the code has another term; else None."""
        divisor = _SMALL[followed.how]
        sizes = (x.defect for x in followed.readings
                 if x.h * divisor == x.place.step and x.ratio > x.clear_ratio)  # fmt: skip
        most, result = _LARGER * max(sizes, default=0.0), None
        for place in places if any(x.step for x in places) else ():
            reading = self.read(followed.structure, place, place.step / divisor, sharp=True)
            is_clear = reading is not None and reading.ratio > reading.clear_ratio
            if reading is not None and is_clear and reading.defect > most:
                most, result = reading.defect, place
        return result

    @cached_property
    def _sides(self) -> list[TrialPlace]:
        """Places on the sides of comparisons in the code that the others do not reach."""
        probe = self.probe
        if not isinstance(probe, DualProbe) or not probe.opaque:
            return []
        sides = Sides(probe.step.names)
        read_places(probe, self.places, lambda x, h: self._values_at(x, h).jacobian, sides)
        return other_sides(probe, sides, farthest_of(probe.step, self.places))
