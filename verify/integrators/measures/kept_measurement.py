"""The defects of structures, measured at places and as h falls, compared with their noise.

Each component of a defect has a natural scale at its place, so that nothing depends on the units of
the coordinates.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from itertools import pairwise

from verify.integrators.measures.distances import LADDERS
from verify.integrators.measures.error_powers import (
    PowerStretches,
    Row,
    SettledPower,
    find_stretches,
    settle_power,
)
from verify.integrators.measures.measured_values import Component, MeasuredValues, components_of
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

# A defect is not 0 if it exceeds its noise by this factor; up to it, and beyond `REFUTING_RATIO`,
# nothing is said.
CLEAR_RATIO = 32.0
# Divisors of the step size, by the kind of the probe; and the number of readings in the noise after
# which no smaller step sizes are tried.
_LADDERS = {"duals": LADDERS["duals"], "floats": LADDERS["floats"]}
_MOST_JACOBIANS = 18  # step sizes at which J is measured by floats, which takes many calls
_QUIET_RATIO, _MOST_QUIET = 10.0, 3
_LOOSE = 0.5  # the last slopes of a place where none has settled may be so much below the power
_MIN_COMPARISONS_OF_LOOP = 4  # in one line of code, in one call


@dataclass(frozen=True)
class KeptReading:
    """The components of a structure's defect at a place, with the step size h (0 for a map)."""

    place: TrialPlace
    h: Fraction
    components: dict[str, Component]

    @property
    def ratio(self) -> float:
        """The largest ratio of a component to its noise."""
        return max(x.ratio for x in self.components.values())

    @property
    def largest(self) -> tuple[str, Component]:
        """The name of the largest component, among those clear of their noise if any are, and the
        component."""
        clear = [x for x in self.components.items() if x[1].ratio > CLEAR_RATIO]
        return max(clear or self.components.items(), key=lambda x: x[1].defect)

    @property
    def row(self) -> Row:
        """h, the largest component and the largest noise, in units of their scales."""
        noise = max(x.blur for x in self.components.values())
        return float(self.h), max(x.defect for x in self.components.values()), noise


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
    def _powers(self) -> list[tuple[PowerStretches, SettledPower]]:
        """The powers of h at the places at which the defect is seen as h falls."""
        settled = []
        for readings, counts in zip(self.ladder, self.counts, strict=True):
            rows = [x.row for x in readings]
            stretches = find_stretches(rows)
            if stretches.is_seen and rows[0][0]:  # a map has no h
                moved = [float(x.h / x.place.step) for x in readings]
                power = settle_power(stretches, rows, counts, moved, self.how, 1.0)
                settled.append((stretches, power))
        return settled

    @property
    def power(self) -> int | None:
        """The power of h by which the defect falls; None if it has not settled wherever it is
        seen."""
        powers = [x.power for _, x in self._powers if x.power is not None]
        if not powers or (self.iterates and self._jumps):
            return None
        # At a place where terms cancel the slopes may not have settled; they must not be lower.
        loose = [x.unsettled[-2:] for x, y in self._powers if y.power is None]
        settled = all(min(x, default=0.0) > min(powers) - _LOOSE for x in loose)
        return min(powers) if settled else None

    @property
    def has_tail(self) -> bool:
        """True if the power of h becomes lower at small step sizes, as where a loop ends early, or
        a term is small."""
        return any(x.tail is not None for _, x in self._powers)

    @property
    def _jumps(self) -> bool:
        """True if the defect grows as h falls, as it does if a loop does one iteration less."""
        for readings in self.ladder:
            clear = [x.row[1] for x in readings if x.ratio > CLEAR_RATIO]
            if any(b > 1.5 * a for a, b in pairwise(clear[1:])):
                return True
        return False


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
        ladder, counts = list[tuple[KeptReading, ...]](), list[tuple[int, ...]]()
        lines, divisors = Counter[Line](), _LADDERS[flat.how]
        if not isinstance(flat.structure, FirstIntegral | Reversible | Symmetric):
            divisors = divisors[:_MOST_JACOBIANS]
        for place in ladder_places(self.places):
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
            ladder.append(tuple(readings))
            counts.append(tuple(numbers))
        loops = any(n >= _MIN_COMPARISONS_OF_LOOP for n in lines.values())
        iterates = loops or any(len(set(x)) > 1 for x in counts)
        return replace(flat, ladder=tuple(ladder), counts=tuple(counts), iterates=iterates)

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
