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
from verify.flows.orbit import exact_orbit, initial_value_digits
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

    def outside(self, point: Point) -> bool:
        """Whether p or q is out of the exact orbit's bounds."""
        orbit = self.orbit
        found = zip((point.p, point.q), orbit.centre, orbit.reach, orbit.turns, strict=True)
        return any(abs(x - c) > _BEYOND * (r or 1) for x, c, r, turns in found if not turns)

    def beyond(self, point: Point) -> bool:
        """Whether a point is out of the exact orbit's bounds, its energy included."""
        driven = self.run.hamiltonian.time_dependent
        return self.outside(point) or (not driven and _too_much(self.energy_error(point)))

    def stays(self, trail: Trail) -> bool:
        """Whether a run keeps within the bounds, to its end."""
        if not trail.finished or any(map(self.outside, trail.points)):
            return False
        return not any(map(_too_much, self.energy_errors(trail)))

    def apart(self, one: Point, other: Point) -> bool:
        pairs = zip((one.p, one.q), (other.p, other.q), self.orbit.reach, strict=True)
        return any(abs(x - y) > _APART * (r or 1) for x, y, r in pairs)

    def together(self, one: Trail, other: Trail) -> bool:
        """Whether two runs of as many steps both end, and are together all the way."""
        pairs = zip(one.points, other.points, strict=True)
        return one.finished and other.finished and not any(self.apart(*x) for x in pairs)


def _too_much(error: Fraction | None) -> bool:
    return error is None or abs(error) > _ENERGY
