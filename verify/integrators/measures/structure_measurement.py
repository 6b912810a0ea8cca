"""The defect S = JᵀΩJ − Ω of the symplectic form at the places, compared with its noise."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from itertools import pairwise

from verify.integrators.measures.distances import STEP_DIVISORS
from verify.integrators.measures.error_powers import find_stretches
from verify.integrators.measures.measurement import (
    Measurement,
    farthest_of,
    ladder_places,
    read_places,
)
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.sides import Sides, other_sides
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.step import StepError, unless_it_fails
from verify.integrators.user_code.user_map import UserMap

# S jumps if a smaller step has one larger by this factor: with a power of h it would fall.
_JUMP_FACTOR = 1.5


@dataclass(frozen=True)
class StructureMeasurement(Measurement[DefectReading]):
    """The measurement of S at all places, in the readings that show anything.

    `blind`: those in which the noise of the probe hides S. `failures`: the messages of calls that
    failed. `sides`: the comparisons of the code.
    """

    blind: tuple[DefectReading, ...] = ()
    failures: tuple[str, ...] = ()
    sides: Sides = field(default_factory=lambda: Sides(()))

    @property
    def seen(self) -> Sequence[DefectReading]:
        """The readings, since the others are `blind`."""
        return self.readings

    @property
    def largest(self) -> DefectReading:
        """The reading of the largest defect, among those that refute S ≡ 0 if any do."""
        largest = super().largest
        assert largest is not None  # noqa: S101 - there are readings
        return largest

    @property
    def power(self) -> int | None:
        """The power of h by which S falls; None if it has not settled at every place where S is
        seen."""
        slopes = [find_stretches([x.row for x in readings]) for readings in self.ladder]
        # The power is that of the smallest step sizes, where the leading term dominates.
        # If a loop iterates, the later stretches may show its tolerance: the first one counts.
        last = 0 if self.iterates else -1
        powers = [x.runs[last].power for x in slopes if x.runs]
        clear = [x for x in slopes if x.is_seen]
        return min(powers) if powers and len(powers) == len(clear) and not self.jumps else None

    @property
    def jumps(self) -> bool:
        """True if S grows as h falls, as it does if a loop does one iteration less."""
        for readings in self.ladder:
            clear = [x.defect for x in readings if x.ratio > x.clear_ratio]
            if any(b > _JUMP_FACTOR * a for a, b in pairwise(clear[1:])):
                return True
        return False

    def is_kept(self, within: Fraction | None = None) -> bool | None:
        """Return True if S is 0 up to the noise, or up to the allowed defect `within`; None if the
        noise is too large to tell."""
        return self.vanishes if within is None else self.is_within(float(within))

    @property
    def volume_kept(self) -> bool | None:
        """True if det J − 1 is 0 up to the noise; None if the noise is too large to tell."""
        return self.is_zero(max(abs(x.volume) / x.volume_noise for x in self.readings))


def structure_of(step: UserMap, probe: Probe, places: Sequence[TrialPlace]) -> StructureMeasurement:
    """Measure S at all of the places, and on the sides of comparisons that these do not reach.

    Raises StepError if there is no reading, or if all of them are blind.
    """
    sides = Sides(step.names)
    readings, failures = read_places(probe, places, probe.reading, sides)
    if isinstance(probe, DualProbe) and readings:
        others = other_sides(probe, sides, farthest_of(step, places))
        more_readings, more_failures = read_places(probe, others, probe.reading, sides)
        readings, failures = readings + more_readings, failures + more_failures
    if not readings:
        raise StepError(failures[0] if failures else "it fails at all places")
    seen = tuple(Measurement(probe.how, tuple(readings)).seen)
    blind = tuple(x for x in readings if x not in seen)
    if not seen:
        blurs = [x.blur for x in blind]
        problem = f"the probe sees nothing: its own error is `{min(blurs):.1e}` to "
        raise StepError(f"{problem}`{max(blurs):.1e}` at the places")
    ladder, counts = _follow_defect(probe, ladder_places(places) if step.takes_step_size else [])
    return StructureMeasurement(
        probe.how, seen, ladder, counts, blind=blind, failures=tuple(failures), sides=sides
    )


def _follow_defect(
    probe: Probe, places: Sequence[TrialPlace]
) -> tuple[tuple[tuple[DefectReading, ...], ...], tuple[tuple[int, ...], ...]]:
    """Measure S as h falls, and count the comparisons of the code; one result for each place."""
    ladder, counts = list[tuple[DefectReading, ...]](), list[tuple[int, ...]]()
    for place in places:
        pairs = list[tuple[DefectReading, int]]()
        for divisor in STEP_DIVISORS:
            if probe.step.seconds_left <= 0:
                break
            reading = unless_it_fails(partial(probe.reading, place, place.step / divisor))
            if reading is not None:
                pairs.append((reading, len(probe.comparisons)))
        ladder.append(tuple(x for x, _ in pairs))
        counts.append(tuple(n for _, n in pairs))
    return tuple(ladder), tuple(counts)
