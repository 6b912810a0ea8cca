"""The inputs of a run in a kernel, whatever the arithmetic.

If H has the period P in t, a step from t is the step from t − m P. So whole periods are taken off a
t that is too large for a fixed-point format. Since P is mostly irrational, 2π/ω, t − m P is rounded
to at most 2^−20 of the format's unit, whatever m is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, Self, TypeVar

import flint

from verify import observables as kinds
from verify.algebra.domain import EVERYWHERE
from verify.arithmetic.arb import Ball, make_ball, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.errors import InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import period_in
from verify.kernels.kernel import Kernel
from verify.kernels.statements import integrals_of
from verify.kernels.step.computation import step_map_of
from verify.kernels.step.integral import Integral, integral_of
from verify.kernels.step.shared_part import source_names
from verify.lazy_sympy import sympy
from verify.observables.observable import Observable
from verify.structures.accumulated import RunValues, accumulate, read_accumulated

_MAX_TIME = 2**12  # for t and for the angle 2π t/P; the format has numbers below 2^15
_SMALL_TIME = 16  # up to this t no period is taken off
_PERIODS_PER_LOOP = 256  # after so many, periods are taken off t again
_GUARD_BITS = 24  # t − m P is computed with so many bits more than the format has
_MOST_CERTIFIED = {True: 16, False: 9}  # coordinates: p and q, or those of equations
_PI_BOUND = Fraction(22, 7)  # is greater than π

T = TypeVar("T")
Times = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Turns:
    """The period P = `factor` π^`power` of H in t, with its multiples taken off t.

    From a reduced `time` a loop makes at most `steps` steps; all of them lie between `times`.
    """

    factor: Fraction
    power: int
    steps: int
    times: Times

    def time(self, t: Fraction, arithmetic: Arithmetic) -> Fraction:
        """Return t − m P, between −P and P."""
        size = max(abs(t), self.factor, 1 / self.factor).__ceil__().bit_length()
        # m may have `size` bits and multiplies the rounding of P, hence the extra bits.
        with working_precision(arithmetic.bits + _GUARD_BITS + 3 * size):
            period: Ball = rational_ball(self.factor) * flint.arb.pi() ** self.power
            multiple = round(midpoint_and_radius(rational_ball(t) / period)[0])
            return midpoint_and_radius(rational_ball(t) - multiple * period)[0]


def turns_of(hamiltonian: Hamiltonian, times: Times, h: Fraction) -> Turns | None:
    """Return the period to take off; None if the times are small enough, or no period of H in t is
    known."""
    latest = max(map(abs, times))
    period = period_in(hamiltonian, "t") if latest > _SMALL_TIME else None
    if period is None:
        return None
    power = 1 if period.has(sympy.pi) else 0
    number = period / sympy.pi**power
    factor = Fraction(int(number.p), int(number.q))
    period_bound = factor * _PI_BOUND**power
    # Then the angle 2π t/P is also below 2^12, since 2π < 8 and P ≥ factor.
    if latest < _MAX_TIME and latest / factor < _MAX_TIME / 8:
        return None
    steps = max(1, (_PERIODS_PER_LOOP * factor / abs(h)).__floor__())
    way = steps * h  # negative on the way back
    first, last = (
        (-period_bound, way + period_bound) if h > 0 else (way - period_bound, period_bound)
    )
    return Turns(factor, power, steps, (first, last))


DEFAULT_SECTIONS = 16  # the number of notes of a run


def _compilable(hamiltonian: Hamiltonian, scheme: str) -> Hamiltonian:
    """Return H with its parameters as the kernel's arguments, if the scheme has a map of it; else H
    with the parameters' values.

    A scheme may have a map for some values only: symplectic Euler has one of (a − 1) p q + … for
    a = 1.
    """
    generic = hamiltonian.with_symbols()
    if _accepts(generic, scheme):
        return generic
    return replace(hamiltonian, expression=hamiltonian.exact, values=(), text_domain=EVERYWHERE)


@lru_cache(maxsize=256)
def _accepts(hamiltonian: Hamiltonian, scheme: str) -> bool:
    """Return True if the scheme has a map of this Hamiltonian."""
    try:
        step_map_of(hamiltonian, scheme)
    except InputError:
        return False
    return True


class RunInputs:
    """H, a scheme, a starting point, a number of steps, and the requested observables.

    `start`: the coordinates, the step size h, and the time t if H depends on it. The state is noted
    `points` times if a series is kept (`points` > 0), else `sections` times. `shares_kernel`: so
    many other runs use the same kernel that it is worth compiling. `aside`: the observables that
    are computed beside the others, with the digits that they have then.
    """

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        start: dict[str, Fraction],
        steps: int,
        observables: frozenset[str],
        points: int,
        keeper: Keeper = NOTHING,
        sections: int = DEFAULT_SECTIONS,
        shares_kernel: bool = False,
        aside: frozenset[str] = frozenset(),
    ) -> None:
        self.hamiltonian, self.scheme = _compilable(hamiltonian, scheme), scheme
        self._hamiltonian_of_user = hamiltonian
        self.parameters = dict(hamiltonian.values)
        self._names = dict(zip(self.coordinates, hamiltonian.coordinates, strict=True))
        sources = {name: source for source, name in self._names.items()}
        self.start = {sources.get(name, name): x for name, x in start.items()}
        self.steps, self.observables, self.points = steps, observables, points
        self.sections = points or sections
        self.keeper, self.shares_kernel = keeper, shares_kernel
        self.aside = aside & observables
        self.start_radii: Mapping[str, Fraction] = {}  # how far the coordinates may be off
        self.restarts = False  # whether the tangent map begins anew at each note

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The names of the coordinates in kernels and in their notes."""
        return source_names(self.hamiltonian)

    @property
    def certifiable(self) -> bool:
        """True if there is a certificate of such runs; the number of terms in a Pfaffian, or in a
        determinant, of the tangent map bounds the number of coordinates."""
        most = _MOST_CERTIFIED[self.hamiltonian.has_energy]
        return not self.implicit and len(self.coordinates) <= most

    def in_user_names(self, values: Mapping[str, T]) -> dict[str, T]:
        """Return values by the names of the system's coordinates in place of those in kernels."""
        return {self._names.get(name, name): x for name, x in values.items()}

    def integral(self, formula: str) -> Integral:
        """Return a function of the state, by its formula."""
        return integral_of(self.hamiltonian, formula)

    @property
    def section(self) -> int:
        """The number of steps between two notes."""
        return -(-self.steps // self.sections)

    @property
    def implicit(self) -> bool:
        """True if a step solves equations; there is no certificate of such runs."""
        return step_map_of(self.hamiltonian, self.scheme).implicit

    def with_observables(
        self, observables: frozenset[str], sections: int = DEFAULT_SECTIONS
    ) -> Self:
        """Return the same run with other observables and `sections`, and without a series."""
        run = copy(self)
        run.observables, run.points, run.restarts = observables, 0, False
        run.sections, run.aside = sections, self.aside & observables
        return run

    def restarting(self, sections: int) -> Self:
        """Return the same run with a tangent map that begins anew after each of the sections."""
        run = copy(self)
        run.sections, run.restarts, run.keeper = sections, True, NOTHING
        return run

    def from_box(self, box: Mapping[str, tuple[Fraction, Fraction]]) -> Self:
        """Return a run of as many steps from a box around a state, for its last state alone.

        `box`: the middle of each coordinate and how far it may be off, which no digits help.
        """
        run = self.with_observables(frozenset())
        run.start = self.start | {name: x for name, (x, _) in box.items()}
        run.start_radii = {name: radius for name, (_, radius) in box.items()}
        run.aside, run.keeper = frozenset(box), NOTHING
        return run

    def start_number(self, arithmetic: Arithmetic, name: str | int, value: Fraction) -> Any:
        """Return the start value of a carried number, by its name if it has one."""
        radius = self.start_radii.get(name) if isinstance(name, str) else None
        if radius and arithmetic.radius:
            with arithmetic.context():
                return make_ball(value, radius)
        return arithmetic.number(value)

    def without(self, names: frozenset[str]) -> Self:
        """Return the same run, with a series if it has one, without these observables."""
        run = copy(self)
        run.observables, run.aside = self.observables - names, self.aside - names
        return run

    @property
    def lighter(self) -> Self:
        """The same run without the observables aside that the loop carries: the greatest |H| may
        need more room than a step does."""
        carried = (each for each in kinds.select(self.aside) if not each.at_end)
        return self.without(frozenset(each.name for each in carried))

    def size_at_start(self, name: str) -> Fraction:
        """Return |I₀| for the change of a function I, and of an accumulated defect the size of the
        structure at the start; 0 for another observable."""
        observable = kinds.find(name)
        if observable and observable.structure:
            # Without the images, M = 0 and Λ = −1, nothing but the structure at the start is left.
            images = {n: rational_ball(x) for n, x in {"lam": Fraction(-1), **self.start}.items()}
            ball = self.accumulate(observable, 0, lambda n: images.get(n, flint.arb(0)))
            return abs(midpoint_and_radius(ball)[0]) if ball.is_finite() else Fraction(0)
        if observable is None or not observable.integral:
            return Fraction(0)
        point = {**self.parameters, **self.in_user_names(self.start)}
        value = self.integral(observable.integral).evaluate(point, 53)
        return Fraction(0) if value is None else abs(midpoint_and_radius(value)[0])

    def accumulate(self, observable: Observable, steps: int, read: Callable[[str], Ball]) -> Ball:
        """Return an accumulated defect, at flint's present precision; not finite if undefined.

        `read`: returns the ball of a number of the kernel after so many steps, by its name.
        """
        system, h = self._hamiltonian_of_user, self.start["h"]
        begin = {n: rational_ball(self.start[n]) for n in self.coordinates}
        end = {n: read(n) for n in self.coordinates}
        if system.time_dependent:
            begin["t"] = rational_ball(self.start["t"])
            end["t"] = rational_ball(self.start["t"] + steps * h)
        size = range(len(self.coordinates))
        jacobian = (
            [[1 + read("lam")]]
            if observable.carried == "lam"
            else [[read(f"m_{a}_{b}") for b in size] for a in size]
        )
        structure = read_accumulated(observable.structure, system)
        boxes = self.in_user_names(begin), self.in_user_names(end)
        return accumulate(
            structure, RunValues(system.coordinates, *boxes, jacobian, rational_ball(h), steps)
        )

    def inputs(self, kernel: Kernel, shift: int) -> dict[str, Fraction]:
        """Return h, the parameters and the scales, by their names in the kernel's source."""
        # The program evaluates ΔJ/h^r; κ = 2^s h^r is computed exactly here, and rounded once.
        h = self.start["h"]
        parameters = {f"x{k}": self.parameters[n] for k, n in enumerate(kernel.parameters)}
        scales = {"kappa": 2**shift * h**kernel.power, "down": Fraction(1, 2**shift)}
        return {"h": h, **parameters, **(scales if kernel.scales else {})}

    def turns(self, arithmetic: Arithmetic) -> Turns | None:
        """Return the period that is taken off t in this arithmetic; None if there is none."""
        if not (arithmetic.absolute and self.hamiltonian.time_dependent):
            return None
        # A function of the state need not have the period of H.
        if any(
            self.integral(formula).depends_on_time for formula in integrals_of(self.observables)
        ):
            return None
        return turns_of(self._hamiltonian_of_user, self.span, self.start["h"])

    def times(self, arithmetic: Arithmetic) -> Times | None:
        """Return bounds of the times at which steps are made in this arithmetic; None if H does not
        depend on time."""
        if not self.hamiltonian.time_dependent:
            return None
        turns = self.turns(arithmetic)
        return turns.times if turns else self.span

    @property
    def span(self) -> Times:
        """The times at the beginning and at the end of the run."""
        first = self.start["t"]
        return first, first + self.steps * self.start["h"]
