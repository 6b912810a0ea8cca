"""The defect of a structure at one place as h falls: its size, its jumps, its slowest power."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

from verify.integrators.measures.error_powers import SettledPower
from verify.integrators.measures.reading import KeptReading

_LAST_SLOPES = 3  # those that count at a place where no power has settled


@dataclass(frozen=True)
class FollowedDefect:
    """The defect at one place as h falls, with the comparisons of the code in each reading;
    `unsettled`: the last slopes that agree on no power."""

    readings: tuple[KeptReading, ...]
    counts: tuple[int, ...]
    unsettled: tuple[float, ...]
    power: SettledPower

    @cached_property
    def sizes(self) -> dict[Fraction, float]:
        """The defects that are clear of their noise, by h in parts of the place's step."""
        clear = (x for x in self.readings if x.ratio > x.clear_ratio)
        return {x.h / x.place.step: x.defect for x in clear}

    def exceeds(self, sizes: Mapping[Fraction, float]) -> bool:
        """Return True if the defect is larger somewhere than `sizes` are."""
        return any(y > sizes.get(n, 0.0) for n, y in self.sizes.items())

    @property
    def jumps(self) -> bool:
        """True if the defect grows as h falls, as it does if a loop does one iteration less.

        Above a stretch of one power that goes on through changes of the count, terms cancel.
        """
        pairs, run = list(zip(self.readings, self.counts, strict=True)), self.power.run
        goes_on = run and len({n for x, n in pairs if run.last <= x.row[0] <= run.first}) > 1
        first = run.first if run and goes_on else math.inf
        clear = [x.defect for x in self.readings if x.ratio > x.clear_ratio and x.row[0] <= first]
        return any(b > 1.5 * a for a, b in pairwise(clear[1:]))

    @property
    def slowest(self) -> float:
        """The least power, of the stretch that has settled and of what is below it."""
        if self.power.power is None:
            return min(self.unsettled[-_LAST_SLOPES:], default=0.0)
        tail = self.power.tail
        return min(self.power.power, self.power.power if tail is None else tail.power or 0)
