"""A step in other coordinates, or in another time, is the same step: what equivariance asks.

M is a linear map of the plane. Where M carries the flow of H to that of K, a scheme that knows of
no coordinates carries its step along, too: Φ_K(M z) = M Φ_H(z).
"""

from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, BallState, ball_steps, unlike
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.every_hamiltonian import RungeKutta, TaylorSeries

Matrix = tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]
_P, _Q = symbol("p"), symbol("q")


def knows_no_coordinates(sample: Sample) -> bool:
    """Whether the scheme treats p and q alike, so that every linear map may be asked for."""
    return isinstance(sample.scheme.every_h, TaylorSeries | RungeKutta)


def transformed_hamiltonian(sample: Sample, matrix: Matrix, factor: Fraction) -> Hamiltonian:
    """K(z) = factor · H(M⁻¹ z)."""
    (a, b), (c, d) = matrix
    determinant = a * d - b * c
    p, q = (
        _rational(x / determinant) * _P + _rational(y / determinant) * _Q
        for x, y in ((d, -b), (-c, a))
    )
    expression = sample.hamiltonian.exact.xreplace({_P: p, _Q: q})
    return Hamiltonian(_rational(factor) * expression)


def same_step(sample: Sample, matrix: Matrix, factor: Fraction, time: Fraction) -> bool:
    """Holds Φ_K of h · `time` at M z against M Φ_H(z); False where one of them is not known.

    Raises Violation where they differ.
    """
    if not sample.brief:
        return False
    (a, b), (c, d) = matrix
    p, q = sample.p, sample.q
    ours = ball_steps(sample.step_map, p, q, sample.step_size, 1)
    if ours is None or not ours[-1].sharp:
        return False
    other = sample.scheme.step_map(transformed_hamiltonian(sample, matrix, factor))
    theirs = ball_steps(other, a * p + b * q, c * p + d * q, sample.step_size * time, 1)
    if theirs is None or not theirs[-1].sharp:
        return False
    with working_precision(BITS):
        p_next, q_next = (
            rational_ball(x) * ours[-1].p + rational_ball(y) * ours[-1].q for x, y in matrix
        )
    wanted = BallState(p_next, q_next, ours[-1].product)
    _must_overlap(wanted, theirs[-1])
    return True


def _must_overlap(wanted: BallState, found: BallState) -> None:
    for name in ("p", "q", "product"):
        x, y = getattr(wanted, name), getattr(found, name)
        if not x.overlaps(y):
            what = "det J" if name == "product" else f"{name}'"
            raise Violation(f"{what} is {unlike(y, x)}")


def _rational(x: Fraction) -> sympy.Rational:
    return sympy.Rational(x.numerator, x.denominator)
