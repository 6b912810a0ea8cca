"""The inputs of a run in a kernel, apart from the arithmetic.

Whole periods of H(p, q, t) are taken off t if it is too large for a fixed-point format.

If H has the period P in t, a step from t is the step from t − m P. As P is 2π/ω more often than
not, t − m P is rounded: by 2^−20 of the format's unit at most, whatever m is.
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

_LARGE = 2**12  # of t, and of the angle that it makes: in the format are numbers below 2^15
_SMALL = 16  # times up to which no period is needed
_PERIODS = 256  # that t goes on before some are taken off again
_SPARE = 24  # bits that t − m P has beyond those of the format
_ABOVE_PI = Fraction(22, 7)

Times = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Turns:
    """The period P = `factor` π^`power`. From one `time` on a loop goes `steps` steps at most, all
    of them made between `times`."""

    factor: Fraction
    power: int
    steps: int
    times: Times

    def time(self, t: Fraction, arithmetic: Arithmetic) -> Fraction:
        """Return t − m P, between −P and P."""
        size = max(abs(t), self.factor, 1 / self.factor).__ceil__().bit_length()
        # m may have `size` bits and multiplies the rounding of P, hence the extra bits.
        with working_precision(arithmetic.bits + _SPARE + 3 * size):
            period: Ball = rational_ball(self.factor) * flint.arb.pi() ** self.power
            whole = round(midpoint_and_radius(rational_ball(t) / period)[0])
            return midpoint_and_radius(rational_ball(t) - whole * period)[0]


def turns_of(hamiltonian: Hamiltonian, times: Times, h: Fraction) -> Turns | None:
    """Return the period to take off; None if the times are small enough, or H is not known to
    have a period in t."""
    latest = max(map(abs, times))
    period = period_in(hamiltonian, "t") if latest > _SMALL else None
    if period is None:
        return None
    power = 1 if period.has(sympy.pi) else 0
    number = period / sympy.pi**power
    factor = Fraction(int(number.p), int(number.q))
    above = factor * _ABOVE_PI**power
    # The angle 2π t/P stays below 2^12 too if t/P is below 2^12/8, as 2π < 8.
    if latest < _LARGE and latest / factor < _LARGE / 8:
        return None
    steps = max(1, (_PERIODS * factor / h).__floor__())
    return Turns(factor, power, steps, (-above, above + steps * h))


SECTIONS = 16  # notes of a run, if nothing is said


def _compilable(hamiltonian: Hamiltonian, scheme: str) -> Hamiltonian:
    """Return H with its parameters as the kernel's arguments, if the scheme accepts it so.

    A scheme may take H for the given values only, as symplectic Euler does (a − 1) p q + … at
    a = 1; then the values are put in.
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
    """H, a scheme, a starting point, a number of steps, and the observables requested of them.

    `start` has p, q, the step size h, and the time t if H depends on it.

    The state is noted `points` times on the way if a series is kept, else `sections` times.
    `shares_kernel`: so many other runs use the same kernel that compiling it pays.
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
        sections: int = SECTIONS,
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
        run.sections = SECTIONS
        return run

    def inputs(self, kernel: Kernel, shift: int) -> dict[str, Fraction]:
        """Return h, the parameters and the scales by their names in the kernel's source."""
        # κ = 2^s h^r is computed exactly here and rounded once, as ΔJ/h^r is what the program
        # evaluates.
        h = self.start["h"]
        parameters = {f"x{k}": self.parameters[n] for k, n in enumerate(kernel.parameters)}
        scales = {"kappa": 2**shift * h**kernel.power, "down": Fraction(1, 2**shift)}
        return {"h": h, **parameters, **(scales if kernel.scales else {})}

    def turns(self, arithmetic: Arithmetic) -> Turns | None:
        """Return the periods that are taken off t in this arithmetic; None if none are."""
        if not (arithmetic.absolute and self.hamiltonian.time_dependent):
            return None
        return turns_of(self._hamiltonian_of_user, self._all_times(), self.start["h"])

    def times(self, arithmetic: Arithmetic) -> Times | None:
        """Return the first and the last time at which a step is made in this arithmetic; None if
        H does not depend on time."""
        if not self.hamiltonian.time_dependent:
            return None
        turns = self.turns(arithmetic)
        return turns.times if turns else self._all_times()

    def _all_times(self) -> Times:
        first = self.start["t"]
        return first, first + self.steps * self.start["h"]
