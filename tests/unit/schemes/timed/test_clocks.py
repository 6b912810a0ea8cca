"""The times that proofs say a scheme's parts or stages have are those at which its step is made."""

from fractions import Fraction

import pytest
import sympy

import verify
from verify.schemes import get, names
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.splitting_conditions import Splitting

H, T0, POWERS = Fraction(1, 4), Fraction(5), (1, 2, 3)
WITH_TIMES = [n for n in names() if not isinstance(get(n).every_h, TaylorSeries)]


def moments(name: str, letter: str, power: int) -> sympy.Expr:
    """Σ b (t₀ + c h)^power over the kicks, or the drifts, that stand in what a proof is of."""
    every_h = get(name).every_h
    conditions = conditions_for(every_h)
    if isinstance(every_h, Splitting):
        kind = {"p": "kick", "q": "drift"}[letter]
        weights = [size if part == kind else sympy.S.Zero for part, size in every_h.parts]
    else:
        weights = conditions.tableau.parts[0 if letter == "p" else -1].weights  # type: ignore[union-attr]
    pairs = zip(weights, conditions.clock, strict=True)
    t0, h = sympy.Rational(T0), sympy.Rational(H)
    return sum((b * (t0 + c * h) ** power for b, c in pairs), sympy.S.Zero)


def stepped(name: str, formula: str, letter: str) -> sympy.Rational:
    """What one step adds, in parts of h, of a run to 40 digits."""
    run = verify.run(formula, name, q=0, p=0, step_size=H, steps=1, t0=T0, digits=40, points=2)
    return sympy.Rational(run.orbit.texts(letter)[-1]) / sympy.Rational(H)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("name", WITH_TIMES)
def test_a_step_takes_the_force_and_the_velocity_at_the_times_that_a_proof_is_of(
    name: str, power: int
) -> None:
    """Of H = −q tⁿ every kick adds tⁿ to p, of H = p tⁿ every drift to q.

    p³q³, which is 0 and has no derivative there, keeps it from being T(p) + V(q), of which a scheme
    for any H may be a splitting with times of its own.
    """
    more = "" if isinstance(get(name).every_h, Splitting) else " + p**3*q**3"
    for formula, letter in ((f"-q*t**{power}{more}", "p"), (f"p*t**{power}{more}", "q")):
        apart = stepped(name, formula, letter) - moments(name, letter, power)
        assert abs(sympy.N(apart, 50)) < 10**-30, (formula, letter)
