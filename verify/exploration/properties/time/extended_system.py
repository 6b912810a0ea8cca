"""The step is that of the autonomous system in which t is one more coordinate, with t' = 1.

Stages are made with (−H_q, H_p, 1) as the slope; of a splitting each of the two flows advances the
clock that the other one reads. H's derivatives are enclosed at each point, and no step map is used.
"""

from collections.abc import Sequence
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclose_all, enclose_over
from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, only_if, require_value
from verify.exploration.reference_steps import BITS, ball_steps, is_narrow, must_overlap
from verify.exploration.sample import Sample
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.conditions.splitting_conditions import Splitting

Point = tuple[Ball, ...]  # the coordinates, and t


def holds(sample: Sample) -> None:
    """Compare the step with one with the slope (f, 1), or with the two clocks of a splitting."""
    only_if(sample.brief)
    with working_precision(BITS):
        expected = _step(sample)
    state = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    for name, true in zip(sample.point, expected, strict=False):
        only_if(is_narrow(true))
        must_overlap(f"{name}' is", state.point[name], true, ", with t as a coordinate")


def _step(sample: Sample) -> Point:
    every_h = sample.scheme.every_h
    start = tuple(rational_ball(sample.start[name]) for name in (*sample.point, "t"))
    if isinstance(every_h, RungeKutta):
        return _step_by_stages(sample, every_h, start)
    if isinstance(every_h, Splitting) and not every_h.times:
        return _step_by_flows(sample, every_h, start)
    raise Silent


def _step_by_stages(sample: Sample, every_h: RungeKutta, start: Point) -> Point:
    h = rational_ball(sample.step_size)

    def advance(weights: Sequence[Fraction], slopes: Sequence[Point]) -> Point:
        total = start
        for weight, k in zip(weights, slopes, strict=True):
            weighted_step = h * rational_ball(weight)
            total = tuple(x + weighted_step * y for x, y in zip(total, k, strict=True))
        return total

    return every_h.step(lambda z: (*_slopes(sample, z), flint.arb(1)), advance)


def _step_by_flows(sample: Sample, every_h: Splitting, start: Point) -> Point:
    n = sample.hamiltonian.degrees
    z, read = list(start[:-1]), {"K": start[-1], "D": start[-1]}  # the clock that each flow reads
    ring, parts = every_h.numbers
    for letter, size, _ in parts:
        increment = rational_ball(sample.step_size) * require_value(enclose_over(ring, size, {}))
        slopes = _slopes(sample, (*z, read[letter]))
        for k in range(n) if letter == "K" else range(n, 2 * n):
            z[k] = z[k] + increment * slopes[k]
        # Each flow of a splitting reads one clock and advances the other one.
        read["D" if letter == "K" else "K"] += increment
    return tuple(z)


def _slopes(sample: Sample, z: Point) -> Sequence[Ball]:
    """Return f at z; Silent if it is not enclosed."""
    ring, slopes = sample.slopes
    box = dict(zip((*sample.point, "t"), z, strict=True))
    enclosures = require_value(enclose_all(ring, slopes, box))
    only_if(all(x.is_finite() for x in enclosures))
    return enclosures
