"""The Jacobian of a run by central differences, of steps that solve equations.

A kernel finds their derivatives by solving other equations, and balls solve none.
"""

from fractions import Fraction

from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import Matrix
from verify.exploration.degrees.mpfr_runs import RunInDegrees
from verify.exploration.sample_in_degrees import SampleInDegrees

_DIGITS, _BITS = 160, 700
_APART = Fraction(1, 10**50)  # the derivatives' error is its square, times the third derivatives
_KNOWN = Fraction(1, 10**70)


def jacobian_of_run(sample: SampleInDegrees) -> tuple[Matrix, Ball]:
    """J of two steps, and what S of it may be where the map is symplectic: the error of J times its
    size, squared as that grows with the derivatives; Silent where an end is not known."""
    columns = []
    for name, x in sample.point.items():
        ends = [
            RunInDegrees(sample.hamiltonian, {**sample.point, name: x + by}, sample).values(
                digits=_DIGITS
            )
            for by in (_APART, -_APART)
        ]
        up, down = ([end[n] for n in sample.point] for end in ends)
        columns.append([(a - b) / (2 * _APART) for a, b in zip(up, down, strict=True)])
    size = 1 + max(abs(x) for column in columns for x in column)
    with working_precision(_BITS):
        found = Matrix([[rational_ball(x) for x in row] for row in zip(*columns, strict=True)])
        return found, rational_ball(_KNOWN * size**4)
