"""Whole periods of H(p, q, t) are taken off t where it is too large for a fixed-point format.

Where H has the period P in t, a step from t is the step from t − m P. As P is 2π/ω more often than
not, t − m P is rounded: by 2^−20 of the format's unit at most, whatever m is.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import Ball, middle_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import period_in
from verify.late import sympy

_LARGE = 2**12  # of t, and of the angle that it makes: in the format are numbers below 2^15
_SMALL = 16  # no period is looked for
_PERIODS = 256  # that t goes on before some are taken off again
_SPARE = 24  # bits that t − m P has beyond those of the format
_ABOVE_PI = Fraction(22, 7)

Times = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Turns:
    """P = `factor` π^`power`. From one `time` on a loop goes `steps` steps at most, all of them
    made between `times`."""

    factor: Fraction
    power: int
    steps: int
    times: Times

    def time(self, t: Fraction, arithmetic: Arithmetic) -> Fraction:
        """t − m P, between −P and P."""
        size = max(abs(t), self.factor, 1 / self.factor).__ceil__().bit_length()
        with working_precision(arithmetic.bits + _SPARE + 3 * size):
            period: Ball = rational_ball(self.factor) * flint.arb.pi() ** self.power
            whole = round(middle_and_radius(rational_ball(t) / period)[0])
            return middle_and_radius(rational_ball(t) - whole * period)[0]


def turns_of(hamiltonian: Hamiltonian, times: Times, h: Fraction) -> Turns | None:
    """None where the times are small enough, or H is not known to have a period in t."""
    latest = max(map(abs, times))
    period = period_in(hamiltonian, "t") if latest > _SMALL else None
    if period is None:
        return None
    power = 1 if period.has(sympy.pi) else 0
    number = period / sympy.pi**power
    factor = Fraction(int(number.p), int(number.q))
    above = factor * _ABOVE_PI**power
    if latest < _LARGE and latest / factor < _LARGE / 8:
        return None
    steps = max(1, (_PERIODS * factor / h).__floor__())
    return Turns(factor, power, steps, (-above, above + steps * h))
