"""What an exact flow must satisfy, measured at high precision; shares no code with the flows.

Each check returns the largest defect relative to the size of what it compares, as an mpf.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import mpmath
import sympy

from tests.helpers.sampled.formulas import P, Q, plain
from verify.arithmetic.flint_precision import working_precision
from verify.flows.ball_evaluation import evaluate
from verify.hamiltonians.named_system import Motion, System, exactly

WORKING = 160  # digits
BITS = 1600  # of the balls, whose middles are compared with so many digits
SHORT = Fraction(1, 10**60)  # a time; at 0 itself ℘ has its pole
STEP = 40  # the derivative is a difference over 10^−STEP, wrong by about 10^(−2·STEP)


@dataclass(frozen=True)
class Case:
    """A system's orbit through (p, q)."""

    system: System
    values: Mapping[str, Fraction]
    p: Fraction
    q: Fraction

    @property
    def motion(self) -> Motion:
        assert self.system.flow is not None
        motion = self.system.flow(self.values, self.p, self.q)
        assert motion is not None
        return motion

    def expression(self) -> sympy.Expr:
        """H by sympy's own reader."""
        put = {plain(n): sympy.Rational(v.numerator, v.denominator) for n, v in self.values.items()}
        return plain(self.system.formula).subs(put)

    def at(self, time: Fraction, digits: int = 80) -> tuple[Fraction, Fraction]:
        (p, q), _ = evaluate(self.motion, (self.p, self.q), time, digits)
        return p, q

    def state(self, time: Fraction) -> tuple[Any, Any]:
        """The middles of the balls at a time, one the motion has, as mpf."""
        if time == 0:
            return number(self.p), number(self.q)
        with working_precision(BITS):
            p, q = self.motion.state(flint.arb(exactly(time)))
        assert all(x.rad() < (1 + abs(x)) * flint.arb(10) ** (20 - WORKING) for x in (p, q))
        return middle(p), middle(q)

    def moved(self, p: Fraction, q: Fraction) -> "Case":
        return Case(self.system, self.values, p, q)


def example(system: System, regime: str) -> Case:
    return Case(system, *system.regime(regime))


def middle(x: Any) -> Any:
    mantissa, exponent = x.mid().man_exp()
    return mpmath.ldexp(int(mantissa), int(exponent))


def number(x: Fraction) -> Any:
    return mpmath.mpf(x.numerator) / x.denominator


def function(expression: sympy.Expr) -> Callable[[Any, Any], Any]:
    made: Callable[[Any, Any], Any] = sympy.lambdify([P, Q], expression, modules="mpmath")
    return made


def energy_defect(case: Case, times: list[Fraction]) -> Any:
    """|H(t) − H(0)| against the size of H's terms."""
    expression = case.expression()
    h = function(expression)
    with mpmath.workdps(WORKING):
        first = h(number(case.p), number(case.q))
        worst = mpmath.mpf(0)
        for time in times:
            p, q = case.state(time)
            size = 1 + abs(first) + p**2 + sum(abs(function(x)(p, q)) for x in expression.args)
            worst = max(worst, abs(h(p, q) - first) / size)
        return worst


def motion_defect(case: Case, times: list[Fraction]) -> Any:
    """|p' + H_q| and |q' − H_p| by a central difference, against their sizes."""
    expression = case.expression()
    h_p, h_q = (function(sympy.diff(expression, x)) for x in (P, Q))
    with mpmath.workdps(WORKING):
        step, worst = Fraction(1, 10**STEP), mpmath.mpf(0)
        for time in times:
            before, at, after = (case.state(t) for t in (time - step, time, time + step))
            slopes = [(y - x) / (2 * number(step)) for x, y in zip(before, after, strict=True)]
            wanted = -h_q(*at), h_p(*at)
            size = 1 + max(abs(x) for x in (*at, *wanted))
            worst = max(worst, *(abs(x - y) / size for x, y in zip(slopes, wanted, strict=True)))
        return worst


def start_defect(case: Case) -> Any:
    """|φ_t(z) − z| for so short a time that it is a derivative's error, |t| H_p and |t| H_q."""
    with mpmath.workdps(WORKING):
        p, q = case.state(SHORT)
        return max(abs(p - number(case.p)), abs(q - number(case.q)))


def group_defect(case: Case, s: Fraction, t: Fraction) -> Any:
    """|φ_s(φ_t(z)) − φ_(s+t)(z)| against the size of the states on the way."""
    middle = case.at(t)
    twice, once = case.moved(*middle).at(s), case.at(s + t)
    with mpmath.workdps(WORKING):
        size = max(map(abs, (*middle, *once, case.p, case.q)), default=Fraction(0)) or Fraction(1)
        return max(abs(number((x - y) / size)) for x, y in zip(twice, once, strict=True))
