"""The measurement of a defect at places and as h falls, compared with its noise.

A defect counts as 0 only up to the noise of the numbers in which the code computes, measured at
each place, or up to the defect that the user allows.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Generic, TypeVar

from verify.integrators.measures.probes import Probe
from verify.integrators.measures.reading import Reading
from verify.integrators.measures.sides import Sides
from verify.integrators.places.trial_places import USER, TrialPlace, select_spread
from verify.integrators.user_code.step import describe_error
from verify.integrators.user_code.user_map import UserMap

REFUTING_RATIO = 4.0  # up to this multiple of its noise a component may be 0
# The noise of components, in units of their scales. With more than the first, nothing is seen at a
# place; with more than the second, a map is not said to preserve anything.
MAX_BLUR = 1e-3
SHARP_BLUR = 1e-7
READING_DIVISORS = 1, 8  # a defect is read with a place's largest step size divided by each
_MAX_LADDER_PLACES = 3  # places at which a defect is followed as h falls
R = TypeVar("R", bound=Reading[Any])
T = TypeVar("T")


@dataclass(frozen=True)
class Measurement(Generic[R]):
    """The measurement of one defect.

    `how`: the kind of probe. `ladder`: the readings at a few places, as h falls at each; `counts`:
    the comparisons of the code in each of them. `loops`: True if the code is seen to have a loop
    that ends by a comparison.
    """

    how: str
    readings: tuple[R, ...]
    ladder: tuple[tuple[R, ...], ...] = ()
    counts: tuple[tuple[int, ...], ...] = ()
    loops: bool = False

    @cached_property
    def seen(self) -> Sequence[R]:
        """The readings in which something can be seen: the sharp ones if half of all are, and those
        whose defect exceeds its noise."""
        sharp = sum(x.blur <= SHARP_BLUR for x in self.readings)
        limit = SHARP_BLUR if 2 * sharp >= len(self.readings) else MAX_BLUR
        return [x for x in self.readings if x.blur <= limit or x.ratio > x.clear_ratio]

    @property
    def ratio(self) -> float:
        """The largest ratio of a component to its noise."""
        return max(x.ratio for x in self.seen)

    @property
    def noise(self) -> float:
        """The largest noise of the readings, in units of their scales."""
        return max(x.blur for x in self.seen)

    @property
    def largest(self) -> R | None:
        """The reading of the largest defect, among those clear of their noise if any are."""
        clear = [x for x in self.seen if x.ratio > x.clear_ratio]
        return max(clear or self.seen, key=lambda x: x.largest[1].defect, default=None)

    @property
    def vanishes(self) -> bool | None:
        """True if the defect is 0 up to the noise; None if the noise may hide or explain it."""
        return self.is_zero(self.ratio) if self.seen else None

    def is_zero(self, ratio: float) -> bool | None:
        """Return True if what has this ratio to its noise is 0; None if the noise hides it."""
        if ratio > self.seen[0].clear_ratio:
            return False
        # A ratio that is no number fails both comparisons.
        return True if ratio <= REFUTING_RATIO and self.noise <= SHARP_BLUR else None

    def is_within(self, allowed: float) -> bool | None:
        """Return True if the defect is at most `allowed`, in natural units; None if that is not
        seen."""
        if any(x.defect - x.blur > allowed for x in self.readings):
            return False
        return all(max(x.defect, x.blur) <= allowed for x in self.readings) or None

    @property
    def iterates(self) -> bool:
        """True if the code has a loop, or the number of its comparisons differs from step size to
        step size."""
        return self.loops or any(len(set(counts)) > 1 for counts in self.counts)


# -- places ----------------------------------------------------------------------------------------


def read_places(
    probe: Probe,
    places: Sequence[TrialPlace],
    read: Callable[[TrialPlace, Fraction], T],
    sides: Sides,
) -> tuple[list[T], list[str]]:
    """Return what is read at the places, noting comparisons; and the messages of failed calls."""
    results, failures = list[T](), list[str]()
    for place in places:
        for h in sizes_at(place):
            if probe.step.seconds_left <= 0:
                return results, failures
            try:
                results.append(read(place, h))
                sides.note(place, h, probe.comparisons)
            except Exception as error:  # the user's code may raise anything
                call = probe.step.describe_call(place.z, h)
                failures.append(f"{describe_error(error)}{call}")
    return results, failures


def sizes_at(place: TrialPlace) -> list[Fraction]:
    """Return the step sizes with which a defect is read at a place; 0 for a map."""
    return [place.step / k for k in (READING_DIVISORS if place.step else READING_DIVISORS[:1])]


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
