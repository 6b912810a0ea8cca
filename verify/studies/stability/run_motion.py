"""The motion in one run: in float64 and in high precision, and the bounds it is held to.

Bounds: ten times the exact orbit's reach in p and in q, and a hundred times its energy scale (see
`verify.flows.orbit`), but for an H that depends on time, whose value the drive changes. Two runs
are apart where they differ by a tenth of the reach.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import mpfr
from verify.flows.functions import functions_at
from verify.flows.orbit import exact_orbit
from verify.flows.orbit_search import initial_value_digits
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.trail import Point, Run, Trail, follow, follow_precisely

_BEYOND = 10  # times the reach
_ENERGY = 100  # times the energy scale
_APART = Fraction(1, 10)  # of the reach
_DIGITS = 40


def float64() -> Arithmetic:
    return number_systems.get("float64", 17)


@lru_cache(maxsize=64)
def _energy(
    hamiltonian: Hamiltonian, digits: int
) -> tuple[Arithmetic, Callable[..., tuple[Any, ...]]]:
    """H as a function of (p, q), and what to evaluate it in; the runs of one H share it."""
    arithmetic = mpfr.make(digits)
    field, _ = hamiltonian.field()
    return arithmetic, functions_at(arithmetic, [(field.ring, field.energy)])


class RunMotion:
    """What is seen of one run; each thing is made when it is looked at."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.orbit = exact_orbit(run.hamiltonian, run.p, run.q, run.time, run.t0)
        # More where the initial value is written with more.
        self.digits = _DIGITS + initial_value_digits((run.p, run.q))
        self._errors: dict[int, tuple[Trail, list[Fraction | None]]] = {}

    @cached_property
    def float64(self) -> Trail:
        return follow(self.run, float64())

    @cached_property
    def precise(self) -> Trail:
        return follow_precisely(self.run, self.digits)

    @cached_property
    def as_far(self) -> Trail:
        """The float64 run for as many steps as were done in high precision."""
        asked = self.precise.steps
        if asked == self.run.steps:
            return self.float64
        return follow(replace(self.run, steps=asked), float64())

    def energy(self, point: Point) -> Fraction | None:
        """H at a point; None where it is not defined there or too large."""
        arithmetic, at = _energy(self.run.hamiltonian, 2 * self.digits)
        try:
            with arithmetic.context():
                (found,) = at(arithmetic.number(point.p), arithmetic.number(point.q))
        except (ArithmeticError, ValueError):
            return None
        return arithmetic.exact(found) if arithmetic.finite(found) else None

    @cached_property
    def _first_energy(self) -> Fraction | None:
        return self.energy(Point(0, self.run.state))

    def energy_error(self, point: Point) -> Fraction | None:
        """H − H(z₀) in parts of the orbit's scale."""
        first, here = self._first_energy, self.energy(point)
        if first is None or here is None:
            return None
        return (here - first) / (self.orbit.scale or 1)

    def energy_errors(self, trail: Trail) -> list[Fraction | None]:
        """Those of a run's points, computed once; none of a driven one."""
        if self.run.hamiltonian.time_dependent:
            return []
        if id(trail) not in self._errors:
            errors = [self.energy_error(point) for point in trail.points]
            self._errors[id(trail)] = trail, errors
        return self._errors[id(trail)][1]

    def worst(self, trail: Trail) -> Fraction | None:
        """The greatest energy error seen in a run, in size."""
        errors = self.energy_errors(trail)
        return max((abs(x) for x in errors if x is not None), default=None)

    @cached_property
    def _bounds(self) -> list[tuple[int, Fraction, Fraction]]:
        """Which coordinates have some, 0 for p and 1 for q, with the least and the greatest."""
        orbit = self.orbit
        of_each = enumerate(zip(orbit.centre, orbit.reach, orbit.turns, strict=True))
        wide = [(k, c, _BEYOND * (r or 1)) for k, (c, r, turns) in of_each if not turns]
        return [(k, centre - half, centre + half) for k, centre, half in wide]

    def outside(self, point: Point) -> bool:
        """Whether p or q is out of the exact orbit's bounds."""
        state = point.state
        return not all(low <= state[k] <= high for k, low, high in self._bounds)

    def beyond(self, point: Point) -> bool:
        """Whether a point is out of the exact orbit's bounds, its energy included."""
        driven = self.run.hamiltonian.time_dependent
        return self.outside(point) or (not driven and _too_much(self.energy_error(point)))

    def stays(self, trail: Trail) -> bool:
        """Whether a run keeps within the bounds, to its end."""
        if not trail.finished or any(map(self.outside, trail.points)):
            return False
        return not any(map(_too_much, self.energy_errors(trail)))

    @cached_property
    def _near(self) -> list[Fraction]:
        """How far p and q of two runs may be from each other."""
        return [_APART * (r or 1) for r in self.orbit.reach]

    def apart(self, one: Point, other: Point) -> bool:
        pairs = zip(one.state, other.state, self._near, strict=True)
        return any(abs(x - y) > near for x, y, near in pairs)

    def together(self, one: Trail, other: Trail) -> bool:
        """Whether two runs of as many steps both end, and are together all the way."""
        pairs = zip(one.points, other.points, strict=True)
        return one.finished and other.finished and not any(self.apart(*x) for x in pairs)


def _too_much(error: Fraction | None) -> bool:
    return error is None or abs(error) > _ENERGY
