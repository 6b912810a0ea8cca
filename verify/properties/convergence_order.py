"""The error of one step against the exact flow shrinks as the proved order of convergence says.

The flow is followed by extrapolation, which knows nothing of Taylor series in h; the step is
enclosed by balls. Both step sizes are tiny, so that the order shows sharply.
"""

from fractions import Fraction

from verify.ball_steps import ball_steps
from verify.balls import Ball, around, rational_ball
from verify.example import Example
from verify.precision import working_precision
from verify.proof.exact_flow import Flow, NoFlowError
from verify.property import Violation

_STEP = Fraction(1, 2**32)
_BITS_A_POWER, _SPARE, _LOST = 32, 200, 60
_DIGITS_A_BIT = Fraction(30103, 100000)
_WITHIN = Fraction(1, 10)  # of a whole order


def holds(example: Example) -> bool:
    if not example.ordinary or example.step_map.solved:
        return False
    order = example.proof.convergence_order
    if order is None:
        return False
    whole, half = (_error(example, h, order) for h in (_STEP, _STEP / 2))
    if whole is None or half is None:
        return False
    for name, large, small in zip("pq", whole, half, strict=True):
        if small.contains(0) or large.contains(0):
            continue
        with working_precision(64):
            found = (large / small).abs_lower().log() / rational_ball(Fraction(2)).log()
            least = order + 1 - rational_ball(_WITHIN)
        if found < least:
            told = f"the step's error in {name} has order {float(found.mid()):.2f}"
            raise Violation(f"{told}, and should have {order + 1} at least")
    return True


def _error(example: Example, h: Fraction, order: int) -> tuple[Ball, Ball] | None:
    """Step minus flow in p and q, as balls; None where one of them is not known."""
    bits = _BITS_A_POWER * (order + 3) + _SPARE
    states = ball_steps(example.step_map, example.p, example.q, h, 1, bits)
    if states is None:
        return None
    field, _ = example.hamiltonian.field()
    flow = Flow(field, int(bits * _DIGITS_A_BIT))
    arithmetic = flow.arithmetic
    try:
        with arithmetic.context():
            start = arithmetic.number(example.p), arithmetic.number(example.q)
            end = flow.advance(start, arithmetic.number(h))
    except NoFlowError:
        return None
    with working_precision(bits):
        exact = [_with_error(arithmetic.exact(x), bits - _LOST) for x in end]
        return states[-1].p - exact[0], states[-1].q - exact[1]


def _with_error(x: Fraction, bits: int) -> Ball:
    """A value that the flow gives to so many bits."""
    return around(x, (1 + abs(x)) / 2**bits)
