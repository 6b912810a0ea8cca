"""What numbers may be of: a run, and how its columns are read. Ours; and what others may have run.

Each mistake of `verify.reference.compare.mistakes` makes another setting of the reference data's.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import UnsupportedError
from verify.errors import InputError
from verify.lockstep import alone
from verify.reference.make.columns import values_of
from verify.reference.make.orbit_points import Bounded, orbit_points
from verify.runs.start import Start
from verify.scenes.results.reference import OrbitRow
from verify.structures import AREA, SYMPLECTIC

_MOST_STEPS = {AREA: 2_000_000, SYMPLECTIC: 20_000}  # run; what is farther is not known


def numbers_of(point: OrbitRow, degrees: int) -> dict[str, Bounded]:
    """The numbers that a point has, by their columns' names."""
    known = values_of(point, degrees).items()
    return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in known if x}


class Points:
    """Orbits after some steps: from the reference data where they have them, else by a run."""

    def __init__(self, known: Mapping[Start, tuple[int, Mapping[int, OrbitRow]]]) -> None:
        """`known`: of an orbit its digits, and its points by step."""
        self._known = known

    def at(self, orbit: Start, step: int, digits: int) -> OrbitRow | None:
        """To so many digits and no fewer; None where there is no such state."""
        have, rows = self._known.get(orbit, (0, {}))
        if have >= digits and step in rows:
            point = rows[step]
            return point if point.status == "finished" else None
        return _run_at(orbit, step, digits)

    def of_other_schemes(self, orbit: Start) -> Iterator[Start]:
        """Those of the reference data that differ from an orbit in the scheme alone."""
        for other in self._known:
            if other != orbit and replace(other, scheme=orbit.scheme) == orbit:
                yield other


@dataclass(frozen=True)
class Setting:
    """A run; row N holds what it is after N + `late` steps, some columns perhaps `exchanged` in
    pairs, and every p perhaps `negated`. `points` knows what it is."""

    orbit: Start
    points: Points = field(compare=False)
    late: int = 0
    exchanged: tuple[tuple[str, str], ...] = ()
    negated: bool = False

    def numbers(self, step: int, digits: int) -> dict[str, Bounded]:
        """What row `step` of such a table has; without the state where there is no such."""
        after = step + self.late
        point = None if after < 0 else self.points.at(self.orbit, after, digits)
        own = numbers_of(point, self.orbit.hamiltonian.degrees) if point else {}
        if self.negated:
            momenta = [n for n in self.orbit.hamiltonian.coordinates if n[0] == "p" and n in own]
            own |= {name: (-own[name][0], own[name][1]) for name in momenta}
        return {self.inner(name): own[name] for name in own}

    def inner(self, name: str) -> str:
        """What stands in a column of that name."""
        for one, other in self.exchanged:
            if name in (one, other):
                return other if name == one else one
        return name


@lru_cache(maxsize=4096)
def _run_at(orbit: Start, step: int, digits: int) -> OrbitRow | None:
    if step > _MOST_STEPS[orbit.hamiltonian.structure]:
        return None
    try:
        (point,) = alone(orbit_points(orbit, steps=(step,), digits=digits))
    except (InputError, UnsupportedError, ArithmeticError):
        return None
    return point if point.status == "finished" else None
