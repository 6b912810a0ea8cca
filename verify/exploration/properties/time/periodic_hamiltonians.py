"""For an H that is periodic in t, a step from a period later is the same step, whatever its size.

The sample's own step size is tested, and a whole period, after which H is as before. The property
applies where t occurs in sin and cos of ω t + φ alone, with a single ω.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import flint

from verify.algebra.identities.polynomials import Generator
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Violation, only_if, require_value
from verify.exploration.reference_steps import (
    BITS,
    BallState,
    ball_steps,
    must_overlap,
    overlap,
    sharp,
    take_step,
)
from verify.exploration.sample import Sample
from verify.functions.function import CIRCLE


def holds(sample: Sample) -> None:
    """Compare the steps one period apart, with their Jacobians."""
    only_if(sample.brief)
    frequency = require_value(_frequency(*sample.slopes))
    start = ball_steps(sample.step_map, sample.start, 0)[0]
    with working_precision(BITS):
        period = 2 * flint.arb.pi() / rational_ball(abs(frequency))
        later = replace(start, point=start.point | {"t": start.point["t"] + period})
        for size in (rational_ball(sample.step_size), period):
            _must_be_alike(*(take_step(sample.step_map, x, size) for x in (start, later)))


def _must_be_alike(one: BallState, other: BallState) -> None:
    for name, x in one.point.items():
        y = other.point[name]
        only_if(sharp(x) and sharp(y))
        if name != "t":
            must_overlap(f"a period later {name}' is", y, x)
    if not overlap(one.step_jacobian, other.step_jacobian):
        raise Violation("a period later J is another")


def _frequency(ring: Ring, slopes: Sequence[Poly]) -> Fraction | None:
    """Return ω if t occurs in sin and cos of ω t + φ alone; None otherwise."""
    # t itself outside of sin and cos is not periodic.
    if any(x.degrees()[ring.places["t"]] > 0 for x in slopes):
        return None
    functions = [g for g in ring.generators_in(*slopes) if g.argument is not None]
    rates = {_rate(ring, g) for g in functions if ring.depends(g.inner, "t")}
    return rates.pop() if len(rates) == 1 else None


def _rate(ring: Ring, g: Generator) -> Fraction | None:
    """Return ω of sin or cos of ω t + φ; None for any other function."""
    rate = ring.diff(g.inner, "t")
    if g.kind not in (CIRCLE.odd, CIRCLE.even) or not rate.is_constant():
        return None
    value = rate.leading_coefficient()
    return Fraction(int(value.numer()), int(value.denom()))
