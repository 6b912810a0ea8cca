"""The defect S of the symplectic form at the places, compared with its noise.

Only the noise of the numbers that the code computes in, measured at each place, or the defect that
the user allows may be ignored.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from itertools import pairwise

from verify.integrators.measures.distances import SPACED
from verify.integrators.measures.error_powers import Row, slopes_of
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.sides import Sides, other_sides
from verify.integrators.places.trial_places import USER, TrialPlace, select_spread
from verify.integrators.user_code.step import StepError, describe_error, unless_it_fails
from verify.integrators.user_code.user_map import UserMap

REFUTES = 4.0  # times its noise that an entry is where it is not 0
_BLIND = 1e-3  # noise beside entries of Ω, which are 1, with which nothing is seen at a place
_SHARP = 1e-7  # the least that a probe has to see for a map to be said to keep anything
_SIZES = 1, 8  # parts of a place's largest step
_LADDER = 3  # places at which S is followed as h falls
_RISES = 1.5  # times the defect of a larger step: no power of h does so


@dataclass(frozen=True)
class StructureMeasurement:
    """`readings` at all places that were seen; `blind`, those at which the probe's own noise hides
    all; `rows`: S as h falls; `lost`: what was raised elsewhere."""

    how: str
    readings: tuple[DefectReading, ...]
    blind: tuple[DefectReading, ...] = ()
    ladder: tuple[TrialPlace, ...] = ()
    rows: tuple[tuple[Row, ...], ...] = ()  # of each place of `ladder`
    counts: tuple[tuple[int, ...], ...] = ()  # of comparisons, beside `rows`
    lost: tuple[str, ...] = ()
    sides: Sides = field(default_factory=lambda: Sides(()))

    @property
    def worst(self) -> DefectReading:
        """The reading whose entry is farthest beyond its noise."""
        return max(self.readings, key=lambda reading: reading.beyond)

    @property
    def largest(self) -> DefectReading:
        """The reading of the largest defect, in units of its place."""
        clear = [x for x in self.readings if x.beyond > REFUTES]
        return max(clear or self.readings, key=lambda reading: reading.defect)

    @property
    def noise(self) -> float:
        """The largest noise of the readings, in units of their places."""
        return max(reading.blur for reading in self.readings)

    def is_kept(self, within: Fraction | None = None) -> bool | None:
        """Return True if S is 0 up to the noise, or up to the allowed defect; None where that is
        open."""
        if within is not None:
            allowed_defect, readings = float(within), self.readings
            if any(x.defect - x.blur > allowed_defect for x in readings):
                return False
            return all(max(x.defect, x.blur) <= allowed_defect for x in readings) or None
        return self._vanishes(self.worst.beyond)

    @property
    def volume_kept(self) -> bool | None:
        """True if det J − 1 is 0 up to the noise; None where that is open."""
        return self._vanishes(max(abs(x.volume) / x.volume_noise for x in self.readings))

    def _vanishes(self, beyond: float) -> bool | None:
        """Return True if a defect that is so many times its noise is 0; None where a smaller one
        would not be seen."""
        if beyond > REFUTES:
            return False
        return True if beyond <= REFUTES and self.noise <= _SHARP else None

    @property
    def power(self) -> int | None:
        """The power of h by which S falls where that has settled; None where none is seen."""
        slopes = [slopes_of(rows) for rows in self.rows]
        # The power is that of the smallest step sizes, where the leading term dominates.
        last = 0 if self.iterates else -1  # below a loop's first stretch it is its tolerance
        powers = [x.runs[last].power for x in slopes if x.runs]
        clear = [x for x in slopes if x.is_seen]
        return min(powers) if powers and len(powers) == len(clear) and not self.jumps else None

    @property
    def jumps(self) -> bool:
        """True if S grows where h falls, as where an iteration does one turn less."""
        for rows in self.rows:
            clear = [(h, x) for h, x, noise in rows if x > REFUTES * noise]
            if any(b > _RISES * a for (_, a), (_, b) in pairwise(clear[1:])):
                return True
        return False

    @property
    def iterates(self) -> bool:
        """True if the number of comparisons differs from step size to step size."""
        return any(len(set(counts)) > 1 for counts in self.counts)


def structure_of(step: UserMap, probe: Probe, places: Sequence[TrialPlace]) -> StructureMeasurement:
    """Measure S at all of the places, and at others on the sides of comparisons that these do not
    reach.

    Raises StepError, or what the user's code raises, where there are too few.
    """
    sides, readings, lost = Sides(step.names), list[DefectReading](), list[str]()
    _read_places(probe, places, readings, sides, lost)
    if isinstance(probe, DualProbe) and readings:
        farthest = _farthest(step, places)
        _read_places(probe, other_sides(probe, sides, farthest), readings, sides, lost)
    if not readings:
        raise StepError(lost[0] if lost else "it fails at all places")
    # Where the probe sees sharply at half of the places the blurred ones are left out; else all
    # count at which anything can be seen. A defect that shows in spite of the noise always counts.
    sharp = sum(x.blur <= _SHARP for x in readings)
    blur_limit = _SHARP if 2 * sharp >= len(readings) else _BLIND
    blind = tuple(x for x in readings if x.blur > blur_limit and x.beyond <= REFUTES)
    seen_readings = tuple(x for x in readings if x not in blind)
    if not seen_readings:
        smallest, blur_limit = min(x.blur for x in blind), max(x.blur for x in blind)
        problem = (
            f"the probe sees nothing: its own error is `{smallest:.1e}` to `{blur_limit:.1e}` "
            "at the places"
        )
        raise StepError(problem)
    ladder = _ladder_places(places) if step.takes_step_size else []
    rows, counts = _follow_defect(step, probe, ladder)
    return StructureMeasurement(
        probe.how, seen_readings, blind, tuple(ladder), rows, counts, tuple(lost), sides
    )


def _read_places(
    probe: Probe,
    places: Sequence[TrialPlace],
    readings: list[DefectReading],
    sides: Sides,
    lost: list[str],
) -> None:
    for place in places:
        for part in _SIZES if place.step else _SIZES[:1]:
            if probe.step.left <= 0:
                return
            try:
                readings.append(probe.reading(place, place.step / part))
                sides.note(place, place.step / part, probe.comparisons)
            except Exception as error:  # the user's code may raise anything
                lost.append(
                    f"{describe_error(error)}{probe.step.place(place.z, place.step / part)}"
                )


def _farthest(step: UserMap, places: Sequence[TrialPlace]) -> dict[str, float]:
    """Return how far each coordinate is followed: 100 units, or as far as 1,000 steps lead."""
    farthest = {
        name: 100.0 * max(max(float(x.units[k]), abs(float(x.z[k]))) for x in places)
        for k, name in enumerate(step.names)
    }
    for place in places[:2]:
        state, h, t = [float(x) for x in place.z], float(place.step), float(place.t)
        try:
            for k in range(1000):
                state = list(step.evaluate(state, h, t + k * h if step.moving else t))
                for name, x in zip(step.names, state, strict=True):
                    farthest[name] = max(farthest[name], abs(x))
                if max(map(abs, state)) > 1e12 * max(map(float, place.units)):
                    break
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return farthest


def _ladder_places(places: Sequence[TrialPlace]) -> list[TrialPlace]:
    """Select a few places, the user's among them."""
    of_user = [x for x in places if x.source == USER]
    return [*of_user, *select_spread([x for x in places if x.source != USER], _LADDER)]


def _follow_defect(
    step: UserMap, probe: Probe, places: Sequence[TrialPlace]
) -> tuple[tuple[tuple[Row, ...], ...], tuple[tuple[int, ...], ...]]:
    """Measure S as h falls, and count the numbers that were compared."""
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
