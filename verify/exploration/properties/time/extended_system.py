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
from verify.exploration.ball_steps import BITS, ball_steps, sharp, unlike
from verify.exploration.degrees import ball_steps as several
from verify.exploration.property import Silent, Violation, known, only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.schemes.every_hamiltonian import RungeKutta
from verify.schemes.splitting_conditions import Splitting

Point = tuple[Ball, ...]  # p, q, t


def holds(sample: Sample) -> None:
    only_if(sample.timed and sample.brief)
    with working_precision(BITS):
        wanted = _step(sample)
    found = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    for name, ours, true in zip("pq", (found.p, found.q), wanted, strict=True):
        only_if(sharp(true))
        if not ours.overlaps(true):
            raise Violation(f"{name}' is {unlike(ours, true)}, with t as a coordinate")


def _step(sample: Sample) -> tuple[Ball, Ball]:
    every_h = sample.scheme.every_h
    start = tuple(rational_ball(sample.start[name]) for name in "pqt")
    if isinstance(every_h, RungeKutta):
        return _by_stages(sample, every_h, start)
    if isinstance(every_h, Splitting) and not every_h.times:
        return _by_flows(sample, every_h, start)
    raise Silent


def _by_stages(sample: Sample, every_h: RungeKutta, start: Point) -> tuple[Ball, Ball]:
    h = rational_ball(sample.step_size)

    def slope(z: Point) -> Point:
        by_p, by_q = _gradient(sample, *z)
        return -by_q, by_p, flint.arb(1)

    def moved(weights: Sequence[Fraction], slopes: Sequence[Point]) -> Point:
        total = start
        for weight, k in zip(weights, slopes, strict=True):
            by = h * rational_ball(weight)
            total = tuple(x + by * y for x, y in zip(total, k, strict=True))
        return total

    p, q, _ = every_h.step(slope, moved)
    return p, q


def _by_flows(sample: Sample, every_h: Splitting, start: Point) -> tuple[Ball, Ball]:
    p, q, begun = start
    read = {"K": begun, "D": begun}  # the clock that each flow reads
    ring, parts = every_h.numbers
    for letter, size in parts:
        by = rational_ball(sample.step_size) * known(enclose_over(ring, size, {}))
        by_p, by_q = _gradient(sample, p, q, read[letter])
        if letter == "K":
            p, read["D"] = p - by * by_q, read["D"] + by
        else:
            q, read["K"] = q + by * by_p, read["K"] + by
    return p, q


def _gradient(sample: Sample, p: Ball, q: Ball, t: Ball) -> tuple[Ball, Ball]:
    """H_p and H_q; Silent where they are not known."""
    field = sample.field
    found = known(enclose_all(field.ring, (field.h_p, field.h_q), {"p": p, "q": q, "t": t}))
    only_if(all(x.is_finite() for x in found))
    return found[0], found[1]


# -- in n degrees of freedom ----------------------------------------------------------------------


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """With (f, 1) as the slope, and the two clocks of a splitting."""
    only_if(sample.timed and sample.brief)
    with working_precision(BITS):
        wanted = _step_in_degrees(sample)
    found = several.ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    for name, true in zip(sample.field.names, wanted, strict=False):
        only_if(sharp(true))
        if not found.point[name].overlaps(true):
            told = unlike(found.point[name], true)
            raise Violation(f"{name}' is {told}, with t as a coordinate")


def _step_in_degrees(sample: SampleInDegrees) -> Point:
    every_h, names = sample.scheme.every_h, (*sample.field.names, "t")
    start = tuple(rational_ball(sample.start[name]) for name in names)
    if isinstance(every_h, RungeKutta):
        h = rational_ball(sample.step_size)

        def moved(weights: Sequence[Fraction], slopes: Sequence[Point]) -> Point:
            total = start
            for weight, k in zip(weights, slopes, strict=True):
                by = h * rational_ball(weight)
                total = tuple(x + by * y for x, y in zip(total, k, strict=True))
            return total

        return every_h.step(lambda z: (*_slopes(sample, z), flint.arb(1)), moved)
    if isinstance(every_h, Splitting) and not every_h.times:
        return _by_flows_in_degrees(sample, every_h, start)
    raise Silent


def _by_flows_in_degrees(sample: SampleInDegrees, every_h: Splitting, start: Point) -> Point:
    n = sample.hamiltonian.degrees
    z, read = list(start[:-1]), {"K": start[-1], "D": start[-1]}
    ring, parts = every_h.numbers
    for letter, size in parts:
        by = rational_ball(sample.step_size) * known(enclose_over(ring, size, {}))
        slopes = _slopes(sample, (*z, read[letter]))
        for k in range(n) if letter == "K" else range(n, 2 * n):
            z[k] = z[k] + by * slopes[k]
        read["D" if letter == "K" else "K"] += by
    return tuple(z)


def _slopes(sample: SampleInDegrees, z: Point) -> Sequence[Ball]:
    """f; Silent where it is not known."""
    field = sample.field
    box = dict(zip((*field.names, "t"), z, strict=True))
    found = known(enclose_all(field.ring, field.slopes, box))
    only_if(all(x.is_finite() for x in found))
    return found
