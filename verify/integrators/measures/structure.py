"""Whether a map keeps the symplectic form where it is looked at: S against its noise.

What may be ignored is the noise of the numbers that the code computes in, measured at each place,
or what the user allows; nothing else.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from itertools import pairwise

from verify.integrators.measures.order import SPACED, Probe
from verify.integrators.measures.sides import Sides, other_sides
from verify.integrators.measures.slopes import Row, slopes_of
from verify.integrators.places.place import USER, Place, spread
from verify.integrators.probes.duals import DualProbe
from verify.integrators.probes.reading import Reading
from verify.integrators.user_code.step import StepError, unless_it_fails, why
from verify.integrators.user_code.user_map import UserMap

REFUTES = 4.0  # times its noise that an entry is where it is not 0
_BLIND = 1e-3  # noise beside entries of Ω, which are 1, with which nothing is seen at a place
_SHARP = 1e-7  # the least that a probe has to see for a map to be said to keep anything
_SIZES = 1, 8  # parts of a place's largest step
_LADDER = 3  # places at which S is followed as h falls
_RISES = 1.5  # times the defect of a larger step: no power of h does so


@dataclass(frozen=True)
class Structure:
    """`readings` at all places that were seen; `blind`, those at which the probe's own noise hides
    all; `rows`: S as h falls; `lost`: what was raised elsewhere."""

    how: str
    readings: tuple[Reading, ...]
    blind: tuple[Reading, ...] = ()
    ladder: tuple[Place, ...] = ()
    rows: tuple[tuple[Row, ...], ...] = ()  # of each place of `ladder`
    counts: tuple[tuple[int, ...], ...] = ()  # of comparisons, beside `rows`
    lost: tuple[str, ...] = ()
    sides: Sides = field(default_factory=lambda: Sides(()))

    @property
    def worst(self) -> Reading:
        """That whose entry is most of all beyond its noise."""
        return max(self.readings, key=lambda reading: reading.beyond)

    @property
    def largest(self) -> Reading:
        """That of the largest defect, in units of its place."""
        clear = [x for x in self.readings if x.beyond > REFUTES]
        return max(clear or self.readings, key=lambda reading: reading.defect)

    @property
    def noise(self) -> float:
        """The largest noise of the readings, in units of their places."""
        return max(reading.blur for reading in self.readings)

    def kept(self, within: Fraction | None = None) -> bool | None:
        """Whether S is 0 up to the noise, or up to what is allowed; None where that is open."""
        if within is not None:
            allowed, readings = float(within), self.readings
            if any(x.defect - x.blur > allowed for x in readings):
                return False
            return all(max(x.defect, x.blur) <= allowed for x in readings) or None
        return self._vanishes(self.worst.beyond)

    @property
    def volume_kept(self) -> bool | None:
        """The same of det J."""
        return self._vanishes(max(abs(x.volume) / x.volume_noise for x in self.readings))

    def _vanishes(self, beyond: float) -> bool | None:
        """Whether what is so many times its noise is 0; None where less would not be seen."""
        if beyond > REFUTES:
            return False
        return True if beyond <= REFUTES and self.noise <= _SHARP else None

    @property
    def power(self) -> int | None:
        """Of h, by which S falls where that has settled; None where none is seen."""
        each = [slopes_of(rows) for rows in self.rows]
        last = 0 if self.iterates else -1  # below a loop's first stretch it is its tolerance
        powers = [x.runs[last].power for x in each if x.runs]
        clear = [x for x in each if x.seen]
        return min(powers) if powers and len(powers) == len(clear) and not self.jumps else None

    @property
    def jumps(self) -> bool:
        """Whether S grows where h falls, as where an iteration does one turn less."""
        for rows in self.rows:
            clear = [(h, x) for h, x, noise in rows if x > REFUTES * noise]
            if any(b > _RISES * a for (_, a), (_, b) in pairwise(clear[1:])):
                return True
        return False

    @property
    def iterates(self) -> bool:
        """Whether the number of comparisons differs from step size to step size."""
        return any(len(set(counts)) > 1 for counts in self.counts)


def structure_of(step: UserMap, probe: Probe, places: Sequence[Place]) -> Structure:
    """At all of the places, and at others on the sides of comparisons that these do not reach.

    Raises StepError, or what the user's code raises, where there are too few.
    """
    sides, readings, lost = Sides(step.names), list[Reading](), list[str]()
    _read(probe, places, readings, sides, lost)
    if isinstance(probe, DualProbe) and readings:
        farthest = _farthest(step, places)
        _read(probe, other_sides(probe, sides, farthest), readings, sides, lost)
    if not readings:
        raise StepError(lost[0] if lost else "it fails at all places")
    sharp = sum(x.blur <= _SHARP for x in readings)
    most = _SHARP if 2 * sharp >= len(readings) else _BLIND
    blind = tuple(x for x in readings if x.blur > most and x.beyond <= REFUTES)
    seen = tuple(x for x in readings if x not in blind)
    if not seen:
        least, most = min(x.blur for x in blind), max(x.blur for x in blind)
        said = (
            f"the probe sees nothing: its own error is `{least:.1e}` to `{most:.1e}` at the places"
        )
        raise StepError(said)
    ladder = _ladder_places(places) if step.stepped else []
    rows, counts = _followed(step, probe, ladder)
    return Structure(probe.how, seen, blind, tuple(ladder), rows, counts, tuple(lost), sides)


def _read(
    probe: Probe, places: Sequence[Place], readings: list[Reading], sides: Sides, lost: list[str]
) -> None:
    for place in places:
        for part in _SIZES if place.step else _SIZES[:1]:
            if probe.step.left <= 0:
                return
            try:
                readings.append(probe.reading(place, place.step / part))
                sides.note(place, place.step / part, probe.comparisons)
            except Exception as error:  # the user's code may raise anything
                lost.append(f"{why(error)}{probe.step.place(place.z, place.step / part)}")


def _farthest(step: UserMap, places: Sequence[Place]) -> dict[str, float]:
    """Up to where each coordinate is followed: 100 units, or as far as 1,000 steps lead."""
    farthest = {
        name: 100.0 * max(max(float(x.units[k]), abs(float(x.z[k]))) for x in places)
        for k, name in enumerate(step.names)
    }
    for place in places[:2]:
        state, h, t = [float(x) for x in place.z], float(place.step), float(place.t)
        try:
            for k in range(1000):
                state = list(step.at(state, h, t + k * h if step.moving else t))
                for name, x in zip(step.names, state, strict=True):
                    farthest[name] = max(farthest[name], abs(x))
                if max(map(abs, state)) > 1e12 * max(map(float, place.units)):
                    break
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return farthest


def _ladder_places(places: Sequence[Place]) -> list[Place]:
    """A few, the user's among them."""
    mine = [x for x in places if x.source == USER]
    return [*mine, *spread([x for x in places if x.source != USER], _LADDER)]


def _followed(
    step: UserMap, probe: Probe, places: Sequence[Place]
) -> tuple[tuple[tuple[Row, ...], ...], tuple[tuple[int, ...], ...]]:
    """S as h falls, and how many numbers were compared."""
    all_rows, all_counts = [], []
    for place in places:
        rows, counts = list[Row](), list[int]()
        for part in SPACED:
            h = place.step / part
            if step.left <= 0:
                break
            reading = unless_it_fails(partial(probe.reading, place, h))
            if reading is not None:
                rows.append((float(h), reading.defect, reading.blur))
                counts.append(len(probe.comparisons))
        all_rows.append(tuple(rows))
        all_counts.append(tuple(counts))
    return tuple(all_rows), tuple(all_counts)
