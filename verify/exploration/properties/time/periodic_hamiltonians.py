"""For an H that is periodic in t, a step from a period later is the same step, whatever its size.

Two step sizes are tested: that of the sample, and then the period itself, after which H is the same
function of p and q. The property applies if t occurs only in sin and cos of ω t + φ, with a single
ω, and if the balls of each step are narrow enough for a comparison; after a step with wide balls,
no other step is tested.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import flint

from verify.algebra.identities.polynomials import Generator
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration import reference_steps
from verify.exploration.property import Violation, only_if, require_value
from verify.exploration.sample import Sample
from verify.functions.function import CIRCLE


def holds(sample: Sample) -> None:
    """Compare the steps one period apart, with their Jacobians.

    Raises Violation if they differ, and Silent if the property does not apply.
    """
    only_if(sample.brief)
    ring, slopes = sample.slopes
    frequency = require_value(_frequency(ring, slopes))
    # The states after 0 steps: the start alone, as balls.
    start = reference_steps.ball_steps(sample.step_map, sample.start, 0)[0]
    with working_precision(reference_steps.BITS):
        period = 2 * flint.arb.pi() / rational_ball(abs(frequency))
        later = replace(start, point=start.point | {"t": start.point["t"] + period})
        for step_size in (rational_ball(sample.step_size), period):
            _must_overlap(
                *(reference_steps.take_step(sample.step_map, x, step_size) for x in (start, later))
            )


def _must_overlap(state: reference_steps.BallState, later_state: reference_steps.BallState) -> None:
    """Raise Violation if two steps one period apart are disjoint, and Silent if a ball is wide."""
    for name, x in state.point.items():
        later_x = later_state.point[name]
        only_if(reference_steps.is_narrow(x) and reference_steps.is_narrow(later_x))
        if name != "t":
            reference_steps.must_overlap(f"a period later {name}' is", later_x, x)
    if not reference_steps.overlap(state.step_jacobian, later_state.step_jacobian):
        raise Violation("a period later J is another")


def _frequency(ring: Ring, slopes: Sequence[Poly]) -> Fraction | None:
    """Return ω if t occurs only in sin and cos of ω t + φ, with a single ω; None otherwise.

    `slopes`: p′ and q′, as elements of the ring; t itself is one of its generators.
    """
    # With t outside of sin and cos, H is not periodic.
    if any(x.degrees()[ring.places["t"]] > 0 for x in slopes):
        return None
    # A generator with an argument is a function of others; `inner` is the argument as an element.
    functions = [g for g in ring.generators_in(*slopes) if g.argument is not None]
    frequencies = {_frequency_of(ring, g) for g in functions if ring.depends(g.inner, "t")}
    # A function that is no sin or cos of ω t + φ contributes None.
    return frequencies.pop() if len(frequencies) == 1 else None


def _frequency_of(ring: Ring, g: Generator) -> Fraction | None:
    """Return ω of sin or cos of ω t + φ; None for any other function."""
    derivative = ring.diff(g.inner, "t")
    if g.kind not in (CIRCLE.odd, CIRCLE.even) or not derivative.is_constant():
        return None
    value = derivative.leading_coefficient()
    return Fraction(int(value.numer()), int(value.denom()))
