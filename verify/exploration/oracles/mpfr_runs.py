"""Runs of two steps in many digits, for implicit steps, which balls do not cover.

A kernel computes the derivatives of such a step from further equations; here the Jacobian of a run
is computed independently, by central differences of runs.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import Matrix
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample

_STEPS = 2
_KNOWN = Fraction(1, 10**30)
_FAR = 10**6

_DIGITS, _BITS = 160, 700
_APART = Fraction(1, 10**50)  # the derivatives' error is its square, times the third derivatives
_DERIVATIVES_KNOWN = Fraction(1, 10**70)


def end_of(sample: Sample, *observables: str, times: int = 1) -> Mapping[str, Fraction]:
    """Return the coordinates and these observables after two steps, in `times` · 160 digits.

    Raises Silent if the run ends early, or a value is so large that digits are lost.
    """
    outcome = replace(sample, steps=_STEPS).run("mpfr", times * _DIGITS, *observables)
    only_if(outcome.done == _STEPS)
    only_if(all(abs(outcome.values[name]) <= _FAR for name in sample.point))
    return {name: outcome.values[name] for name in (*sample.point, *observables)}


def must_agree(computed: Mapping[str, Fraction], expected: Mapping[str, Fraction]) -> None:
    """Raise Violation if a number differs from the expected one within 30 digits."""
    for name, x in computed.items():
        if abs(x - expected[name]) > _KNOWN * (1 + abs(expected[name])):
            comparison = f"{decimal(x, 12)}, and should be {decimal(expected[name], 12)}"
            raise Violation(f"{name} is {comparison}")


def jacobian_of_run(sample: Sample) -> tuple[Matrix, Ball]:
    """Return the tangent map J of two steps, and a bound of its S if the map is symplectic.

    The bound is 10⁻⁷⁰ times the fourth power of the size of J: S multiplies the error of J by J,
    and that error grows with the derivatives. Raises Silent if the end of a run is not known.
    """
    columns = []
    for name, x in sample.point.items():
        neighbours = (
            sample.with_place((sample.point | {name: x + by}).values()) for by in (_APART, -_APART)
        )
        # Central differences are off by the square of _APART, 10⁻¹⁰⁰, times third derivatives.
        up, down = (end_of(each).values() for each in neighbours)
        columns.append([(a - b) / (2 * _APART) for a, b in zip(up, down, strict=True)])
    size = 1 + max(abs(x) for column in columns for x in column)
    with working_precision(_BITS):
        jacobian = Matrix([[rational_ball(x) for x in row] for row in zip(*columns, strict=True)])
        return jacobian, rational_ball(_DERIVATIVES_KNOWN * size**4)
