"""A setting: a run, and how its columns are read. Ours; and what others may have run.

Each mistake of `verify.reference.compare.mistakes` makes another setting of the reference data's.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import UnsupportedError
from verify.errors import InputError
from verify.lockstep import run_alone
from verify.reference.make.columns import values_of
from verify.reference.make.orbit_points import Bounded, orbit_points
from verify.runs.start import Start
from verify.scenes.results.reference import OrbitRow
from verify.structures import AREA, SYMPLECTIC

_MOST_STEPS = {AREA: 2_000_000, SYMPLECTIC: 20_000}  # run; what is farther is not known


def numbers_of(point: OrbitRow, degrees: int) -> dict[str, Bounded]:
    """Return the numbers that a point has, by their columns' names."""
    values = values_of(point, degrees).items()
    return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in values if x}


class Points:
    """Orbits after some steps: from the reference data where they have them, otherwise by a run."""

    def __init__(self, cache: Mapping[Start, tuple[int, Mapping[int, OrbitRow]]]) -> None:
        """`cache`: the digits of an orbit, and its points by step."""
        self._cache = cache

    def point_at(self, orbit: Start, step: int, digits: int) -> OrbitRow | None:
        """Return the point after so many steps, to `digits` digits at least; None where there is
        no such state."""
        have, rows = self._cache.get(orbit, (0, {}))
        # Published points are exact to their digits and cost nothing; a run is made only for more
        # digits or other steps.
        if have >= digits and step in rows:
            point = rows[step]
            return point if point.status == "finished" else None
        return _run_to(orbit, step, digits)

    def of_other_schemes(self, orbit: Start) -> Iterator[Start]:
        """Yield the orbits of the reference data that differ from `orbit` in the scheme alone."""
        for other in self._cache:
            if other != orbit and replace(other, scheme=orbit.scheme) == orbit:
                yield other


@dataclass(frozen=True)
class Setting:
    """A run and a reading of it: row N holds the point after N + `late` steps, some columns
    perhaps `exchanged` in pairs, and every p perhaps `negated`. `points` supplies the numbers."""

    orbit: Start
    points: Points = field(compare=False)
    late: int = 0
    exchanged: tuple[tuple[str, str], ...] = ()
    negated: bool = False

    def numbers(self, step: int, digits: int) -> dict[str, Bounded]:
        """Return the numbers of row `step` of such a table; without the state where there is
        none."""
        after = step + self.late
        point = None if after < 0 else self.points.point_at(self.orbit, after, digits)
        values = numbers_of(point, self.orbit.hamiltonian.degrees) if point else {}
        if self.negated:
            momenta = [n for n in self.orbit.hamiltonian.coordinates if n[0] == "p" and n in values]
            values |= {name: (-values[name][0], values[name][1]) for name in momenta}
        return {self.inner(name): values[name] for name in values}

    def inner(self, name: str) -> str:
        """Return the name of the number that stands in a column of that name."""
        for one, other in self.exchanged:
            if name in (one, other):
                return other if name == one else one
        return name


@lru_cache(maxsize=4096)
def _run_to(orbit: Start, step: int, digits: int) -> OrbitRow | None:
    if step > _MOST_STEPS[orbit.hamiltonian.structure]:
        return None
    try:
        (point,) = run_alone(orbit_points(orbit, steps=(step,), digits=digits))
    except (InputError, UnsupportedError, ArithmeticError):
        return None
    return point if point.status == "finished" else None
