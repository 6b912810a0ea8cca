"""Runs of two steps in many digits: for steps that solve equations, which balls do not.

A kernel finds the derivatives of such a step by solving other equations; here the Jacobian of a run
is made of central differences of runs.
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
    """The coordinates and these observables after two steps, in 160 digits or so many times as
    many; Silent where they leave the range in which digits are kept."""
    found = replace(sample, steps=_STEPS).run("mpfr", times * _DIGITS, *observables)
    only_if(found.done == _STEPS)
    only_if(all(abs(found.values[name]) <= _FAR for name in sample.point))
    return {name: found.values[name] for name in (*sample.point, *observables)}


def must_agree(found: Mapping[str, Fraction], wanted: Mapping[str, Fraction]) -> None:
    """Violation where a number is not what is wanted, to 30 digits."""
    for name, x in found.items():
        if abs(x - wanted[name]) > _KNOWN * (1 + abs(wanted[name])):
            told = f"{decimal(x, 12)}, and should be {decimal(wanted[name], 12)}"
            raise Violation(f"{name} is {told}")


def jacobian_of_run(sample: Sample) -> tuple[Matrix, Ball]:
    """J of two steps, and what S of it may be where the map is symplectic: the error of J times its
    size, squared as that grows with the derivatives; Silent where an end is not known."""
    columns = []
    for name, x in sample.point.items():
        beside = (sample.at((sample.point | {name: x + by}).values()) for by in (_APART, -_APART))
        up, down = (end_of(each).values() for each in beside)
        columns.append([(a - b) / (2 * _APART) for a, b in zip(up, down, strict=True)])
    size = 1 + max(abs(x) for column in columns for x in column)
    with working_precision(_BITS):
        found = Matrix([[rational_ball(x) for x in row] for row in zip(*columns, strict=True)])
        return found, rational_ball(_DERIVATIVES_KNOWN * size**4)
