"""The error of one step against the exact flow shrinks as the proved order of convergence says.

The flow is followed by extrapolation, which uses no Taylor series in h; the step is enclosed by
balls. Both step sizes are tiny, so that the order shows sharply. At some points the order is
higher; if it is so at the initial value, a neighbouring point is tried.
"""

from collections.abc import Mapping
from fractions import Fraction

from verify.arithmetic.arb import Ball, make_ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Violation, only_if, require_value, silent_at
from verify.exploration.reference_steps import ball_steps
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NoFlowError

_STEP = Fraction(1, 2**96)
_BITS_PER_POWER, _SPARE_BITS, _LOST_BITS = 96, 200, 60
_DIGITS_PER_BIT = Fraction(30103, 100000)
_ORDER_TOLERANCE = Fraction(1, 10)
_NEIGHBOUR_SHIFT = Fraction(3, 70)
Point = Mapping[str, Fraction]


def holds(sample: Sample) -> None:
    only_if(sample.in_closed_form)
    order = require_value(sample.proof.convergence_order)
    neighbour = {
        name: x + _NEIGHBOUR_SHIFT / k for k, (name, x) in enumerate(sample.start.items(), start=2)
    }
    for point in (sample.start, neighbour):
        orders = _orders(sample, point, order)
        _must_reach(orders, order + 1)
        if not _passes(orders, order + 1):
            return
    raise Violation(f"the step's error has a higher order than {order + 1}, that proved")


def _must_reach(orders: Mapping[str, Ball | None], order: int) -> None:
    """Raise Violation if the order of an error is lower."""
    for name, ball in orders.items():
        if ball is not None and ball < rational_ball(order - _ORDER_TOLERANCE):
            message = f"the step's error in {name} has order {float(ball.mid()):.2f}"
            raise Violation(f"{message}, and should have {order} at least")


def _passes(orders: Mapping[str, Ball | None], order: int) -> bool:
    """Return True if the orders of the errors in all coordinates are higher."""
    limit = rational_ball(order + _ORDER_TOLERANCE)
    return all(ball is None or ball > limit for ball in orders.values())


def _orders(sample: Sample, point: Point, order: int) -> dict[str, Ball | None]:
    """Return the power of h with which each error shrinks; None for one that may be 0."""
    # Halving h divides the error by 2^order, so that the order is a binary logarithm.
    whole, half = (_error(sample, {**point, "h": h}, order) for h in (_STEP, _STEP / 2))
    with working_precision(64):
        return {
            name: None if x.contains(0) or half[name].contains(0) else _power(x, half[name])
            for name, x in whole.items()
        }


def _power(large: Ball, small: Ball) -> Ball:
    return abs(large / small).log() / rational_ball(Fraction(2)).log()


def _error(sample: Sample, start: Point, order: int) -> dict[str, Ball]:
    """Return step minus flow in each coordinate, as balls; Silent if one of them is unknown."""
    bits = _BITS_PER_POWER * (order + 3) + _SPARE_BITS
    after = ball_steps(sample.step_map, start, 1, bits)[-1]
    flow = sample.flow(int(bits * _DIGITS_PER_BIT))
    arithmetic = flow.arithmetic
    with silent_at(NoFlowError), arithmetic.context():
        end = flow.advance(flow.state(start), arithmetic.number(start["h"]))
    with working_precision(bits):
        return {
            name: after.point[name] - _with_error(arithmetic.exact(x), bits - _LOST_BITS)
            for name, x in zip(sample.point, end, strict=False)
        }


def _with_error(x: Fraction, bits: int) -> Ball:
    """Enclose a value of the flow that has that number of right bits."""
    return make_ball(x, (1 + abs(x)) / 2**bits)
