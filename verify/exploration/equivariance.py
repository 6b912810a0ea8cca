"""A step in other coordinates, or in another time, is the same step: what equivariance asks.

M is a linear map of the plane. Where M carries the flow of H to that of K, a scheme that knows of
no coordinates carries its step along, too: Φ_K(M z) = M Φ_H(z).
"""

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
_P, _Q = symbol("p"), symbol("q")


def knows_no_coordinates(sample: Sample) -> bool:
    """Whether the scheme treats p and q alike, so that every linear map may be asked for."""
    return isinstance(sample.scheme.every_h, TaylorSeries | RungeKutta)


def transformed_hamiltonian(sample: Sample, matrix: Matrix, factor: Fraction) -> Hamiltonian:
    """K(z) = factor · H(M⁻¹ z)."""
    (a, b), (c, d) = matrix
    determinant = a * d - b * c
    p, q = (
        sympy.Rational(x / determinant) * _P + sympy.Rational(y / determinant) * _Q
        for x, y in ((d, -b), (-c, a))
    )
    expression = sample.hamiltonian.exact.xreplace({_P: p, _Q: q})
    return Hamiltonian(sympy.Rational(factor) * expression)


def must_be_same_step(sample: Sample, matrix: Matrix, factor: Fraction, time: Fraction) -> None:
    """Violation where Φ_K of h · `time` at M z is not M Φ_H(z); Silent where one is not known."""
    only_if(sample.brief)
    (a, b), (c, d) = matrix
    p, q = sample.p, sample.q
    ours = ball_steps(sample.step_map, p, q, sample.step_size, 1)[-1].sharp()
    other = sample.scheme.step_map(transformed_hamiltonian(sample, matrix, factor))
    point = a * p + b * q, c * p + d * q
    theirs = ball_steps(other, *point, sample.step_size * time, 1)[-1].sharp()
    with working_precision(BITS):
        p_next, q_next = (rational_ball(x) * ours.p + rational_ball(y) * ours.q for x, y in matrix)
    pairs = (theirs.p, p_next), (theirs.q, q_next), (theirs.product, ours.product)
    for what, (found, wanted) in zip(("p'", "q'", "det J"), pairs, strict=True):
        if not found.overlaps(wanted):
            raise Violation(f"{what} is {unlike(found, wanted)}")
