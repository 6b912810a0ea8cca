"""The inputs of a run in a kernel, whatever the arithmetic.

If H has the period P in t, a step from t is the step from t − m P. So whole periods are taken off a
t that is too large for a fixed-point format. Since P is mostly irrational, 2π/ω, t − m P is rounded
to at most 2^−20 of the format's unit, whatever m is.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Self

import flint

from verify.arithmetic.arb import Ball, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.errors import InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import period_in
from verify.kernels.kernel import Kernel
from verify.kernels.step.computation import step_map_of
from verify.lazy_sympy import sympy

_MAX_TIME = 2**12  # for t and for the angle 2π t/P; the format has numbers below 2^15
_SMALL_TIME = 16  # up to this t no period is taken off
_PERIODS_PER_LOOP = 256  # after so many, periods are taken off t again
_GUARD_BITS = 24  # t − m P is computed with so many bits more than the format has
_PI_BOUND = Fraction(22, 7)  # is greater than π

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
    steps = max(1, (_PERIODS_PER_LOOP * factor / h).__floor__())
    return Turns(factor, power, steps, (-period_bound, period_bound + steps * h))


DEFAULT_SECTIONS = 16  # the number of notes of a run


def _compilable(hamiltonian: Hamiltonian, scheme: str) -> Hamiltonian:
    """Return H with its parameters as the kernel's arguments, if the scheme has a map of it; else H
    with the parameters' values.

    A scheme may have a map for some values only: symplectic Euler has one of (a − 1) p q + … for
    a = 1.
    """
    generic = hamiltonian.with_symbols()
    return generic if _accepts(generic, scheme) else Hamiltonian(hamiltonian.exact)


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
    many other runs use the same kernel that it is worth compiling.
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
    ) -> None:
        self.hamiltonian, self.scheme = _compilable(hamiltonian, scheme), scheme
        self._hamiltonian_of_user = hamiltonian
        self.parameters, self.start = dict(hamiltonian.values), start
        self.steps, self.observables, self.points = steps, observables, points
        self.sections = points or sections
        self.keeper, self.shares_kernel = keeper, shares_kernel

    @property
    def section(self) -> int:
        """The number of steps between two notes."""
        return -(-self.steps // self.sections)

    @property
    def implicit(self) -> bool:
        """True if a step solves equations; there is no certificate of such runs."""
        return step_map_of(self.hamiltonian, self.scheme).implicit

    def with_observables(self, observables: frozenset[str]) -> Self:
        """Return the same run with other observables, and without a series."""
        run = copy(self)
        run.observables, run.points = observables, 0
        run.sections = DEFAULT_SECTIONS
        return run

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
        return turns_of(self._hamiltonian_of_user, self._all_times(), self.start["h"])

    def times(self, arithmetic: Arithmetic) -> Times | None:
        """Return bounds of the times at which steps are made in this arithmetic; None if H does not
        depend on time."""
        if not self.hamiltonian.time_dependent:
            return None
        turns = self.turns(arithmetic)
        return turns.times if turns else self._all_times()

    def _all_times(self) -> Times:
        first = self.start["t"]
        return first, first + self.steps * self.start["h"]
