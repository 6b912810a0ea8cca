"""Reference steps, with which kernels and maps are compared: in balls, and with many digits.

Steps of a map in ball arithmetic need no kernel. They are rigorous, and share no code with the
number systems that they check. ΔJ is computed from the entries of J, not from its closed form.
Implicit steps, which balls do not cover, are run by a kernel with many digits. The kernel computes
their derivatives from further equations; here the Jacobian of a run is computed independently, by
central differences of runs.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations

import flint

from verify.arithmetic.arb import Ball, format_ball, rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, Violation, only_if, require_value
from verify.exploration.sample import Sample
from verify.schemes.maps.ball_algebra import UndefinedError, step_in_balls
from verify.schemes.maps.step_map import StepMap

# 320 bits leave room for balls that widen from step to step.
BITS = 320
_MIN_BITS = 120  # the known bits of a ball that is narrow enough for a comparison
# Runs with many digits: the number of steps, the accuracy of their ends, and the greatest |end|.
_STEPS_OF_RUN = 2
_ACCURACY = Fraction(1, 10**30)
_MAX_END = 10**6
_RUN_DIGITS, _JACOBIAN_BITS = 160, 700
# The shift of a central difference, whose error is its square times a third derivative.
_DIFFERENCE = Fraction(1, 10**50)
_DERIVATIVE_ACCURACY = Fraction(1, 10**70)
Matrix = flint.arb_mat
Point = dict[str, Ball]


@dataclass(frozen=True)
class BallState:
    """The state after some steps.

    `point`: the coordinates by name, with t if H depends on it; `matrix`: the tangent map of all
    steps; `step_jacobian`: the Jacobian of the last step; `product`: Π det J_k over the steps.
    """

    point: Point
    matrix: Matrix
    step_jacobian: Matrix
    product: Ball

    def sharp(self) -> "BallState":
        """Return the state itself; Silent if a ball is too wide for a comparison.

        In the plane the product is tested instead of the entries of the tangent map, which may be
        wide where the product is not.
        """
        planar = self.matrix.nrows() == 2
        only_if(all(map(is_narrow, self.point.values())))
        only_if(all(map(is_narrow, [self.product] if planar else self.matrix.entries())))
        return self


def ball_steps(
    step: StepMap, start: Mapping[str, Fraction], steps: int, bits: int = BITS
) -> Sequence[BallState]:
    """Return the states after 0, 1, … steps; Silent if the map is implicit, or not defined there.

    `start`: the coordinates, h, which may be negative, and t if H depends on it.
    """
    only_if(not step.implicit)
    with working_precision(bits):
        point = {name: rational_ball(x) for name, x in start.items() if name != "h"}
        unit_matrix = identity(len(step.hamiltonian.coordinates))
        states = [BallState(point, unit_matrix, unit_matrix, flint.arb(1))]
        for _ in range(steps):
            states.append(take_step(step, states[-1], rational_ball(start["h"])))
    return states


def take_step(step: StepMap, state: BallState, h: Ball) -> BallState:
    """Compute one step from a state, in flint's present precision; raises Silent if it is
    undefined."""
    # A map given by formulas has no step in operations, only its closed form.
    point, closed_form = dict(state.point), step.closed if step.formulas is not None else None
    try:
        changes, slopes = step_in_balls(
            step.field, closed_form or require_value(step.step), point, h
        )
    except UndefinedError:
        raise Silent from None
    for name, change in zip(step.field.names, changes, strict=True):
        point[name] += change
    # The changes are returned without z itself, so that their derivative lacks the identity.
    jacobian = slopes + identity(len(changes))
    # A scheme advances t with the step, and t is no coordinate of the Jacobian.
    if "t" in point:
        point["t"] += h
    return BallState(point, jacobian * state.matrix, jacobian, state.product * jacobian.det())


def identity(size: int) -> Matrix:
    """Return the identity matrix."""
    return Matrix([[int(a == b) for b in range(size)] for a in range(size)])


def omega(size: int) -> Matrix:
    """Return Ω of Σ dp_i∧dq_i, for z = (p1 … pn, q1 … qn)."""
    n = size // 2
    return Matrix([[(b == a + n) - (a == b + n) for b in range(size)] for a in range(size)])


def defect(jacobian: Matrix) -> Matrix:
    """Return S = JᵀΩJ − Ω, in flint's present precision."""
    canonical = omega(jacobian.nrows())
    return jacobian.transpose() * canonical * jacobian - canonical


def entries(form: Matrix) -> Iterator[Ball]:
    """Yield the entries of an antisymmetric matrix above its diagonal."""
    for a, b in combinations(range(form.nrows()), 2):
        yield form[a, b]


def largest(form: Matrix) -> Ball:
    """Return the greatest |entry|."""
    maximum = flint.arb(0)
    for x in entries(form):
        maximum = maximum.max(abs(x))
    return maximum


def overlap(x: Matrix, y: Matrix) -> bool:
    """Return True if two matrices may be the same."""
    return all(a.overlaps(b) for a, b in zip(x.entries(), y.entries(), strict=True))


def unlike(computed: Ball, expected: Ball) -> str:
    """Describe both values, and their difference, as 12 digits of them may be equal."""
    with working_precision(BITS):
        difference = computed - expected
    comparison = f"{format_ball(computed, 12)}, and should be {format_ball(expected, 12)}"
    return f"{comparison} (too large by {format_ball(difference, 3)})"


def must_overlap(what: str, computed: Ball, expected: Ball, how: str = "") -> None:
    """Raise Violation if the two balls are disjoint.

    `what`: the subject of the message, with its verb; `how`: where the expected value comes from.
    """
    if not computed.overlaps(expected):
        raise Violation(f"{what} {unlike(computed, expected)}{how}")


def is_narrow(x: Ball) -> bool:
    """Return True if the radius of a ball is small: relative to |x| if |x| > 1, else absolutely."""
    return bool(x.is_finite()) and x.rad() * 2**_MIN_BITS < 1 + x.abs_lower()


# -- with many digits -----------------------------------------------------------------------------


def end_of(sample: Sample, *observables: str, times: int = 1) -> Mapping[str, Fraction]:
    """Return the coordinates and these observables after two steps, in `times` · 160 digits.

    Raises Silent if the run ends early, or a value is so large that digits are lost.
    """
    outcome = replace(sample, steps=_STEPS_OF_RUN).run("mpfr", times * _RUN_DIGITS, *observables)
    only_if(outcome.done == _STEPS_OF_RUN)
    only_if(all(abs(outcome.values[name]) <= _MAX_END for name in sample.point))
    return {name: outcome.values[name] for name in (*sample.point, *observables)}


def must_agree(computed: Mapping[str, Fraction], expected: Mapping[str, Fraction]) -> None:
    """Raise Violation if a number differs from the expected one within 30 digits."""
    for name, x in computed.items():
        if abs(x - expected[name]) > _ACCURACY * (1 + abs(expected[name])):
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
            sample.with_place((sample.point | {name: x + dx}).values())
            for dx in (_DIFFERENCE, -_DIFFERENCE)
        )
        # Central differences are off by 10⁻¹⁰⁰ times third derivatives.
        forward, backward = (end_of(neighbour).values() for neighbour in neighbours)
        columns.append(
            [(a - b) / (2 * _DIFFERENCE) for a, b in zip(forward, backward, strict=True)]
        )
    size = 1 + max(abs(x) for column in columns for x in column)
    with working_precision(_JACOBIAN_BITS):
        jacobian = Matrix([[rational_ball(x) for x in row] for row in zip(*columns, strict=True)])
        return jacobian, rational_ball(_DERIVATIVE_ACCURACY * size**4)
