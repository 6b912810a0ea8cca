"""For an H that is periodic in t, a step from a period later is the same step, whatever its size.

Of the sample's own step size, and of a whole period, after which the clock stands where it stood.
Asked where t is in sin and cos of ω t + φ alone, of one ω or of multiples of one.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import flint

from verify.algebra.generator import Generator
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, BallState, ball_steps, sharp, stepped, unlike
from verify.exploration.degrees import ball_steps as several
from verify.exploration.property import Violation, known, only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees


def holds(sample: Sample) -> None:
    only_if(sample.timed and sample.brief)
    field = sample.field
    frequency = known(_frequency(field.ring, (field.h_p, field.h_q)))
    start = ball_steps(sample.step_map, sample.start, 0)[0]
    with working_precision(BITS):
        period = 2 * flint.arb.pi() / rational_ball(abs(frequency))
        for size in (rational_ball(sample.step_size), period):
            _must_be_alike(sample, start, period, size)


def _must_be_alike(sample: Sample, start: BallState, period: Ball, size: Ball) -> None:
    assert start.t is not None  # noqa: S101 - H depends on t
    now, later = (
        stepped(sample.step_map, replace(start, t=start.t + shift), size) for shift in (0, period)
    )
    pairs = (now.p, later.p), (now.q, later.q), (now.product, later.product)
    for what, (one, other) in zip(("p'", "q'", "det J"), pairs, strict=True):
        only_if(sharp(one) and sharp(other))
        if not one.overlaps(other):
            raise Violation(f"a period later {what} is {unlike(other, one)}")


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same of the Jacobian."""
    only_if(sample.timed and sample.brief)
    field = sample.field
    frequency = known(_frequency(field.ring, field.slopes))
    start = several.ball_steps(sample.step_map, sample.start, 0)[0]
    with working_precision(BITS):
        period = 2 * flint.arb.pi() / rational_ball(abs(frequency))
        later = replace(start, point=start.point | {"t": start.point["t"] + period})
        for size in (rational_ball(sample.step_size), period):
            one, other = (several.stepped(sample.step_map, x, size) for x in (start, later))
            for name in field.names:
                x, y = one.point[name], other.point[name]
                only_if(sharp(x) and sharp(y))
                if not x.overlaps(y):
                    raise Violation(f"a period later {name}' is {unlike(y, x)}")
            if not several.overlap(one.own, other.own):
                raise Violation("a period later J is another")


def _frequency(ring: Ring, slopes: Sequence[Poly]) -> Fraction | None:
    """ω, where t is in sin and cos of ω t + φ alone; None elsewhere."""
    found = set[Fraction]()
    if any(x.degrees()[ring.places["t"]] > 0 for x in slopes):
        return None
    for g in ring.generators_in(*slopes):
        if g.argument is None or not ring.depends(g.argument, "t"):
            continue
        rate = _rate(ring, g)
        if rate is None:
            return None
        found.add(rate)
    return found.pop() if len(found) == 1 else None


def _rate(ring: Ring, g: Generator) -> Fraction | None:
    """ω of sin or cos of ω t + φ; None of anything else."""
    rate = ring.diff(g.inner, "t")
    if g.kind not in ("sin", "cos") or not rate.is_constant():
        return None
    value = rate.leading_coefficient()
    return Fraction(int(value.numer()), int(value.denom()))
