"""The reading of a structure's defect at a place, and the defect there as h falls.

Each component of a defect has a natural scale at its place, so that nothing depends on the units of
the coordinates.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

from verify.integrators.measures.error_powers import Row, SettledPower
from verify.integrators.measures.measured_values import Component
from verify.integrators.places.trial_places import TrialPlace

# A defect is not 0 if it exceeds its noise by this factor; up to it, and beyond `REFUTING_RATIO`,
# nothing is said.
CLEAR_RATIO = 32.0
_LAST_SLOPES = 3  # those that count at a place where no power has settled


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
        clear = (x for x in self.readings if x.ratio > CLEAR_RATIO)
        return {x.h / x.place.step: x.row[1] for x in clear}

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
        clear = [x.row[1] for x in self.readings if x.ratio > CLEAR_RATIO and x.row[0] <= first]
        return any(b > 1.5 * a for a, b in pairwise(clear[1:]))

    @property
    def slowest(self) -> float:
        """The least power, of the stretch that has settled and of what is below it."""
        if self.power.power is None:
            return min(self.unsettled[-_LAST_SLOPES:], default=0.0)
        tail = self.power.tail
        return min(self.power.power, self.power.power if tail is None else tail.power or 0)
