"""The error of one step against the exact flow shrinks as the proved order of convergence says.

The flow is followed by extrapolation, which knows nothing of Taylor series in h; the step is
enclosed by balls. Both step sizes are tiny, so that the order shows sharply. At some points the
order is higher; where it is so at the initial value, it is not at one beside it.
"""

from collections.abc import Mapping
from fractions import Fraction

from verify.arithmetic.arb import Ball, around, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import ball_steps
from verify.exploration.degrees import ball_steps as several
from verify.exploration.property import Violation, known, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.flows.degrees.extrapolation import FlowInDegrees
from verify.flows.extrapolation import Flow, NoFlowError

_STEP = Fraction(1, 2**96)
_BITS_A_POWER, _SPARE, _LOST = 96, 200, 60
_DIGITS_A_BIT = Fraction(30103, 100000)
_WITHIN = Fraction(1, 10)  # of a whole order
_BESIDE = {"p": Fraction(3, 70), "q": Fraction(1, 55), "t": Fraction(2, 65)}


def holds(sample: Sample) -> None:
    only_if(sample.ordinary and not sample.step_map.implicit)
    order = known(sample.proof.convergence_order)
    beside = {name: x + _BESIDE.get(name, 0) for name, x in sample.start.items()}
    for point in (sample.start, beside):
        found = _orders(sample, point, order)
        _must_reach(found, order + 1)
        if not _passes(found, order + 1):
            return
    raise Violation(f"the step's error has a higher order than {order + 1}, that proved")


def _must_reach(found: Mapping[str, Ball | None], order: int) -> None:
    """Violation where an error's order is lower."""
    for name, ball in found.items():
        if ball is not None and ball < rational_ball(order - _WITHIN):
            told = f"the step's error in {name} has order {float(ball.mid()):.2f}"
            raise Violation(f"{told}, and should have {order} at least")


def _passes(found: Mapping[str, Ball | None], order: int) -> bool:
    """Whether the errors' orders in p and q are both higher."""
    most = rational_ball(order + _WITHIN)
    return all(ball is None or ball > most for ball in found.values())


def _orders(sample: Sample, point: Mapping[str, Fraction], order: int) -> dict[str, Ball | None]:
    """By which power of h the errors in p and q shrink, None for one that may be 0."""
    whole, half = (_error(sample, {**point, "h": h}, order) for h in (_STEP, _STEP / 2))
    found: dict[str, Ball | None] = {}
    with working_precision(64):
        for name, large, small in zip("pq", whole, half, strict=True):
            known = not (small.contains(0) or large.contains(0))
            found[name] = _power(large, small) if known else None
    return found


def _error(sample: Sample, start: Mapping[str, Fraction], order: int) -> tuple[Ball, Ball]:
    """Step minus flow in p and q, as balls; Silent where one of them is not known."""
    bits = _BITS_A_POWER * (order + 3) + _SPARE
    after = ball_steps(sample.step_map, start, 1, bits)[-1]
    flow = Flow(sample.field, int(bits * _DIGITS_A_BIT))
    arithmetic = flow.arithmetic
    with silent_at(NoFlowError), arithmetic.context():
        z = flow.state(start)
        end = flow.advance(z, arithmetic.number(start["h"]))
    with working_precision(bits):
        exact = [_with_error(arithmetic.exact(x), bits - _LOST) for x in end[:2]]
        return after.p - exact[0], after.q - exact[1]


def _with_error(x: Fraction, bits: int) -> Ball:
    """A value that the flow gives to so many bits."""
    return around(x, (1 + abs(x)) / 2**bits)


# -- in n degrees of freedom ----------------------------------------------------------------------

_IN_DEGREES = 3  # one in so many samples
_ASIDE = Fraction(3, 70)


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same of each coordinate."""
    only_if(sample.is_turn(_IN_DEGREES) and sample.ordinary and not sample.step_map.implicit)
    order = known(sample.proof.convergence_order)
    beside = {name: x + _ASIDE / (k + 2) for k, (name, x) in enumerate(sample.start.items())}
    for point in (sample.start, beside):
        whole, half = (_gap(sample, {**point, "h": h}, order) for h in (_STEP, _STEP / 2))
        with working_precision(64):
            found = {
                name: None if x.contains(0) or half[name].contains(0) else _power(x, half[name])
                for name, x in whole.items()
            }
        _must_reach(found, order + 1)
        if not _passes(found, order + 1):
            return
    raise Violation(f"the step's error has a higher order than {order + 1}, that proved")


def _power(large: Ball, small: Ball) -> Ball:
    return abs(large / small).log() / rational_ball(Fraction(2)).log()


def _gap(sample: SampleInDegrees, start: Mapping[str, Fraction], order: int) -> dict[str, Ball]:
    """Step minus flow in each coordinate."""
    bits = _BITS_A_POWER * (order + 3) + _SPARE
    after = several.ball_steps(sample.step_map, start, 1, bits)[-1]
    flow = FlowInDegrees(sample.field, int(bits * _DIGITS_A_BIT))
    arithmetic = flow.arithmetic
    with silent_at(NoFlowError), arithmetic.context():
        end = flow.advance(flow.state(start), arithmetic.number(start["h"]))
    with working_precision(bits):
        return {
            name: after.point[name] - _with_error(arithmetic.exact(x), bits - _LOST)
            for name, x in zip(sample.field.names, end, strict=False)
        }
