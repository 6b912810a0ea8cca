"""The motion in one run, in float64 and in high precision, and the bounds that it must keep.

Bounds: ten times the exact orbit's reach in each coordinate, and a hundred times its energy scale
(see `verify.studies.stability.exact_motion`), but for an H that depends on time, whose value the
drive changes. Two runs are apart where they differ by a tenth of the reach.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from operator import sub
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic.exact import fraction, quotient
from verify.arithmetic.number_system import Arithmetic
from verify.flows.functions import energies_at
from verify.flows.orbit_search import ExactOrbit
from verify.studies.stability.exact_motion import Sensitivity, displace, distance, exact_motion
from verify.studies.stability.trail import Point, Run, Trail, follow, follow_precisely

_BEYOND = 10  # times the reach
_ENERGY = 100  # times the energy scale
_APART = Fraction(1, 10)  # of the reach
_DIGITS = 40
_NEIGHBOUR = Fraction(1, 10**20)  # of the reach, one of the scheme's own orbit


def float64() -> Arithmetic:
    return number_systems.get("float64", 17)


class RunMotion:
    """One run compared with the exact orbit; each of its trails is computed when it is needed."""

    def __init__(self, run: Run, orbit: ExactOrbit | None = None) -> None:
        """Take `orbit`, where it is given, for the exact one over the run's time or longer."""
        self.run = run
        self.orbit = orbit or exact_motion(run.hamiltonian, run.state, run.time, run.t0)
        self.digits = _DIGITS + self.orbit.more_digits
        self._energy_cache: dict[int, tuple[Trail, list[Any]]] = {}

    @cached_property
    def float64(self) -> Trail:
        return follow(self.run, float64())

    @cached_property
    def precise(self) -> Trail:
        return follow_precisely(self.run, self.digits)

    @cached_property
    def float64_as_far(self) -> Trail:
        """The float64 run for as many steps as were done in high precision."""
        steps = self.precise.steps
        if steps == self.run.steps:
            return self.float64
        return follow(self.run.with_steps(steps), float64())

    @cached_property
    def sensitivity(self) -> Sensitivity:
        """The sensitivity of the scheme's own map, in high precision."""
        reach = self.orbit.reach
        near = self.run.onwards(displace(self.run.state, reach, _NEIGHBOUR), 0, self.precise.steps)
        other, h = follow_precisely(near, self.digits), float(self.run.step_size)
        pairs = list(zip(self.precise.points, other.points, strict=False))
        distances = [distance(a.state, b.state, reach) for a, b in pairs]
        return Sensitivity.from_distances([a.step * h for a, _ in pairs], distances)

    @cached_property
    def _first_energy(self) -> Any:
        """The energy H(z₀); None where it is not defined or too large."""
        (energy,) = self._energies_at([[x] for x in self.run.state])
        return None if energy is None else quotient(energy)

    @cached_property
    def _scale(self) -> Any:
        return quotient(self.orbit.scale or 1)

    def _energies_at(self, columns: Sequence[Sequence[Any]]) -> list[Any]:
        return energies_at(self.run.hamiltonian, 2 * self.digits, columns)

    def _error(self, energy: Any) -> Any:
        """Return H − H(z₀) in parts of the orbit's scale; None where either is not known."""
        if energy is None or self._first_energy is None:
            return None
        return (quotient(energy) - self._first_energy) / self._scale

    def _energies(self, trail: Trail) -> list[Any]:
        """Return H at a run's points, computed once; an empty list for a driven run."""
        if self.run.hamiltonian.time_dependent:
            return []
        if id(trail) not in self._energy_cache:
            self._energy_cache[id(trail)] = trail, self._energies_at(trail.columns)
        return self._energy_cache[id(trail)][1]

    def energy_errors(self, trail: Trail) -> list[Any]:
        """Return the energy errors at a run's points, as gmpy2's rationals.

        One is None where it is not known. The list is empty for a driven run.
        """
        return list(map(self._error, self._energies(trail)))

    def _extreme_errors(self, trail: Trail) -> list[Any]:
        """Return the least and the greatest energy error, and None where some are not known."""
        energies = self._energies(trail)
        values = [x for x in energies if x is not None]
        # Only the extremes of H are turned into errors: the error is monotone in H.
        ends: list[Any] = [self._error(end(values)) for end in (min, max)] if values else []
        return ends if len(values) == len(energies) else [*ends, None]

    def worst(self, trail: Trail) -> Fraction | None:
        """Return the greatest |energy error| of a run."""
        sizes = [abs(x) for x in self._extreme_errors(trail) if x is not None]
        return fraction(max(sizes)) if sizes else None

    @cached_property
    def _bounds(self) -> list[tuple[int, Any, Any]]:
        """The coordinates that have bounds, by their places, with the least and the greatest."""
        orbit = self.orbit
        of_each = enumerate(zip(orbit.centre, orbit.reach, orbit.turns, strict=True))
        # An angle has no bound. A coordinate that does not move has reach 0, for which 1 stands.
        wide = [(k, c, _BEYOND * (r or 1)) for k, (c, r, turns) in of_each if not turns]
        return [(k, quotient(centre - half), quotient(centre + half)) for k, centre, half in wide]

    def _is_inside(self, columns: Sequence[Sequence[Any]]) -> bool:
        """Return True if no coordinate of these states is out of the exact orbit's bounds."""
        bounds = ((columns[k], low, high) for k, low, high in self._bounds)
        return all(low <= min(x) and max(x) <= high for x, low, high in bounds)

    def is_outside(self, point: Point) -> bool:
        """Return True if a coordinate is out of the exact orbit's bounds."""
        return not self._is_inside([[x] for x in point.state])

    def is_beyond(self, point: Point) -> bool:
        """Return True if a point is out of the exact orbit's bounds, its energy included."""
        outside = self.is_outside(point)
        if outside or self.run.hamiltonian.time_dependent:
            return outside
        (energy,) = self._energies_at([[x] for x in point.state])
        return _is_too_large(self._error(energy))

    def stays(self, trail: Trail) -> bool:
        """Return True if a run keeps within the bounds, to its end."""
        if not (trail.is_finished and self._is_inside(trail.columns)):
            return False
        return not any(map(_is_too_large, self._extreme_errors(trail)))

    @cached_property
    def _near(self) -> list[Any]:
        """The distances up to which the coordinates of two runs count as together."""
        return [quotient(_APART * (r or 1)) for r in self.orbit.reach]

    def are_apart(self, one: Point, other: Point) -> bool:
        pairs = zip(one.state, other.state, self._near, strict=True)
        return any(abs(x - y) > near for x, y, near in pairs)

    def stay_together(self, one: Trail, other: Trail) -> bool:
        """Return True if two runs of as many steps both finish, and are together all the way."""
        columns = zip(one.columns, other.columns, self._near, strict=True)
        return (
            one.is_finished
            and other.is_finished
            and all(_farthest(x, y) <= d for x, y, d in columns)
        )


def _farthest(one: Sequence[Any], other: Sequence[Any]) -> Any:
    """Return the greatest |x − y| of pairs of numbers."""
    return max(map(abs, map(sub, map(quotient, one), map(quotient, other))))


def _is_too_large(error: Any) -> bool:
    return error is None or abs(error) > _ENERGY
