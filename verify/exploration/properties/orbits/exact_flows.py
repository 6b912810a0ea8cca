"""The exact flow keeps H, comes back with time reversed, and moves G by the leading term X·G.

G is the potential of the leading coefficient of ΔJ, where it has one. The flow is followed by
extrapolation, to 40 digits over a short time.
"""

from contextlib import suppress
from fractions import Fraction

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, rational_ball, shown
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, Violation, known, only_if, silent_at
from verify.exploration.sample import Sample
from verify.flows.extrapolation import Flow, NoFlowError
from verify.proof.potential import potential_of

_IN, _OF_POTENTIALS = 3, 6  # one in so many samples
_DIGITS, _BITS = 40, 220
_TIME, _INSTANT = Fraction(1, 1000), Fraction(1, 2**60)
_MOST_STEPS = 100  # of the flow, in so short a time: a field that wants more is left out
_KNOWN = Fraction(1, 10**30)  # of a state that was followed over _TIME
_WITHIN = Fraction(1, 2**20)  # of 1 + |L|: what (G(φ_t z) − G(z))/t leaves out is t times H's own
Point = tuple[Fraction, Fraction]


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN) and sample.ordinary)
    field = sample.field
    flow = Flow(field, _DIGITS)
    start = sample.p, sample.q
    after = _flow_to(flow, start, _TIME)
    back = _flow_to(flow, after, -_TIME)
    for name, x, y in zip("pq", start, back, strict=True):
        if abs(x - y) > _KNOWN * (1 + abs(x)):
            raise Violation(f"{name} comes back as {float(y)!r}, from {float(x)!r}")
    before, then = (_value(field.ring, field.energy, point) for point in (start, after))
    with working_precision(_BITS):
        if abs(then - before) > rational_ball(_KNOWN) * 10**6 * (1 + abs(before)):
            raise Violation(f"H is {shown(before, 12)}, and after {_TIME} {shown(then, 12)}")
    if sample.is_turn(_OF_POTENTIALS):
        with suppress(Silent):  # the flow has been looked at
            _potential_must_move(sample)


def _potential_must_move(sample: Sample) -> None:
    """Holds the change of G over an instant against L, where there is a G."""
    only_if(sample.polynomial)
    found = potential_of(sample.proof, sample.scheme)
    only_if(bool(found.holds))
    ring, potential = known(found.element)
    start = sample.p, sample.q
    end = _flow_to(Flow(sample.field, 2 * _DIGITS), start, _INSTANT)
    ends = [_value(ring, potential, point) for point in (start, end)]
    wanted = _value(*known(sample.proof.first.element), start)
    with working_precision(_BITS):
        rate = (ends[1] - ends[0]) / rational_ball(_INSTANT)
        wrong = abs(rate - wanted) > (1 + abs(wanted)) * rational_ball(_WITHIN)
    if wrong:
        raise Violation(f"G grows by {shown(rate, 12)} a time, and L is {shown(wanted, 12)}")


def _flow_to(flow: Flow, start: Point, time: Fraction) -> Point:
    arithmetic = flow.arithmetic
    first = arithmetic.number(start[0]), arithmetic.number(start[1])
    with silent_at(NoFlowError):
        p, q = flow.follow(first, time, _MOST_STEPS)
    return arithmetic.exact(p), arithmetic.exact(q)


def _value(ring: Ring, x: Poly, point: Point) -> Ball:
    return known(enclose(ring, x, dict(zip("pq", point, strict=True)), _BITS))
