"""What numbers may be of: a run, and how its columns are read. Ours; and what others may have run.

Each mistake of `verify.reference.compare.mistakes` makes another setting of the reference data's.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import UnsupportedError
from verify.errors import InputError
from verify.kernels.orbit import Orbit
from verify.reference.make.columns import values_of
from verify.reference.make.orbit_points import orbit_points
from verify.scenes.results.reference import OrbitPoint

_MOST_STEPS = 2_000_000  # run; what is farther is not known
Bounded = tuple[Fraction, Fraction]  # a value and its radius


def numbers_of(point: OrbitPoint) -> dict[str, Bounded]:
    """The numbers that a point has, by their columns' names."""
    known = values_of(point, 1).items()
    return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in known if x}


class Points:
    """Orbits after some steps: from the reference data where they have them, else by a run."""

    def __init__(self, known: Mapping[Orbit, tuple[int, Mapping[int, OrbitPoint]]]) -> None:
        """`known`: of an orbit its digits, and its points by step."""
        self._known = known

    def at(self, orbit: Orbit, step: int, digits: int) -> OrbitPoint | None:
        """To so many digits and no fewer; None where there is no such state."""
        have, rows = self._known.get(orbit, (0, {}))
        if have >= digits and step in rows:
            point = rows[step]
            return point if point.status == "finished" else None
        return _run_at(orbit, step, digits)


@dataclass(frozen=True)
class Setting:
    """A run; row N holds what it is after N + `late` steps, the columns perhaps `swapped`, and p
    perhaps `negated`. `points` knows what it is."""

    orbit: Orbit
    points: Points = field(compare=False)
    late: int = 0
    swapped: bool = False
    negated: bool = False

    def numbers(self, step: int, digits: int) -> dict[str, Bounded]:
        """What row `step` of such a table has; without p and q where there is no such state."""
        after = step + self.late
        point = None if after < 0 else self.points.at(self.orbit, after, digits)
        own = numbers_of(point) if point else {}
        if self.negated and "p" in own:
            own["p"] = -own["p"][0], own["p"][1]
        return {self.inner(name): own[name] for name in own}

    def inner(self, name: str) -> str:
        """What stands in a column of that name."""
        return {"p": "q", "q": "p"}.get(name, name) if self.swapped else name


@lru_cache(maxsize=4096)
def _run_at(orbit: Orbit, step: int, digits: int) -> OrbitPoint | None:
    if step > _MOST_STEPS:
        return None
    try:
        (point,) = orbit_points(orbit, steps=(step,), digits=digits)
    except (InputError, UnsupportedError, ArithmeticError):
        return None
    return point if point.status == "finished" else None
