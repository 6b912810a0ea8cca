"""A step in other coordinates, or in another time, is the same step: what equivariance asks.

M is a linear map of the plane. Where M carries the flow of H to that of K, a scheme that knows of
no coordinates carries its step along, too: Φ_K(M z) = M Φ_H(z). An H that depends on time is K's at
another time, too: what H is at t, K is at c t + s.
"""

from dataclasses import dataclass
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, ball_steps, unlike
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.every_hamiltonian import RungeKutta, TaylorSeries

Matrix = tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]
_P, _Q, _T = map(symbol, "pqt")
IDENTITY: Matrix = ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(1)))


@dataclass(frozen=True)
class Change:
    """K = `factor` · H in the coordinates M z, at the time `pace` · t + `shift`."""

    matrix: Matrix = IDENTITY
    factor: Fraction = Fraction(1)
    pace: Fraction = Fraction(1)
    shift: Fraction = Fraction(0)


def knows_no_coordinates(sample: Sample) -> bool:
    """Whether the scheme treats p and q alike, so that every linear map may be asked for."""
    return isinstance(sample.scheme.every_h, TaylorSeries | RungeKutta)


def transformed_hamiltonian(sample: Sample, change: Change) -> Hamiltonian:
    """K(z, t) = factor · H(M⁻¹ z, (t − shift)/pace)."""
    (a, b), (c, d) = change.matrix
    determinant = a * d - b * c
    p, q = (
        sympy.Rational(x / determinant) * _P + sympy.Rational(y / determinant) * _Q
        for x, y in ((d, -b), (-c, a))
    )
    time = (_T - sympy.Rational(change.shift)) / sympy.Rational(change.pace)
    expression = sample.hamiltonian.exact.xreplace({_P: p, _Q: q, _T: time})
    return Hamiltonian(sympy.Rational(change.factor) * expression)


def must_be_same_step(sample: Sample, change: Change) -> None:
    """Violation where Φ_K of h · pace at M z is not M Φ_H(z); Silent where one is not known."""
    only_if(sample.brief)
    (a, b), (c, d) = change.matrix
    p, q = sample.p, sample.q
    ours = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    other = sample.scheme.step_map(transformed_hamiltonian(sample, change))
    start = {"p": a * p + b * q, "q": c * p + d * q, "h": sample.step_size * change.pace}
    if sample.timed:
        start["t"] = sample.t0 * change.pace + change.shift
    theirs = ball_steps(other, start, 1)[-1].sharp()
    with working_precision(BITS):
        p_next, q_next = (
            rational_ball(x) * ours.p + rational_ball(y) * ours.q for x, y in change.matrix
        )
    pairs = (theirs.p, p_next), (theirs.q, q_next), (theirs.product, ours.product)
    for what, (found, wanted) in zip(("p'", "q'", "det J"), pairs, strict=True):
        if not found.overlaps(wanted):
            raise Violation(f"{what} is {unlike(found, wanted)}")
