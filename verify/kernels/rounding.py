"""Rounding errors of a program's values, bounded operation by operation over a box of states.

Every value gets an interval that holds it for all states in the box, and a bound on the error of
its computed value there. The rules are those of forward error analysis, without linearisation:
with |x̂ − x| ≤ a and |ŷ − y| ≤ b, |x̂ŷ − xy| ≤ |x| b + |y| a + a b, and a function's error is its
greatest slope over the interval, widened by a, times a; each operation adds its own rounding.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import flint

from verify.algebra.enclosure import BALLS, square
from verify.arithmetic.number_system import Arithmetic
from verify.functions import in_rings
from verify.kernels.step.kinds import Op
from verify.kernels.step.operations import StepProgram

Ball = flint.arb
PRECISION = 96  # bits for intervals and bounds, which nobody needs to many digits


@dataclass(frozen=True)
class RoundedValue:
    """An interval that holds the exact value, and a bound on the error of the computed one."""

    interval: Ball
    error: Ball

    @cached_property
    def size(self) -> Ball:
        """An upper bound on |exact value|."""
        return self.interval.abs_upper()

    @property
    def magnitude(self) -> Ball:
        """An upper bound on |exact value| and |computed value|."""
        return self.size + self.error

    @property
    def computed_interval(self) -> Ball:
        """An interval that holds the computed value, not only the exact one."""
        return self.interval + self.error * flint.arb(0, 1)


Rounding = Callable[[Op, Ball], Ball]  # an operation and its result's magnitude → its own error


def rounding_of(arithmetic: Arithmetic) -> Rounding:
    """Return the rounding error of one operation of the arithmetic, which must be known."""
    rounding = arithmetic.rounding
    assert rounding is not None, arithmetic.name  # noqa: S101 - the caller's condition

    def rounding_error(op: Op, size: Ball) -> Ball:
        if op.kind == "const":
            exact_constant = arithmetic.exact(arithmetic.number(op.value))
            return flint.arb(abs(_fmpq(exact_constant) - _fmpq(op.value)))
        return rounding(*_function(op), size)

    return rounding_error


_UNIT, _LEAST = flint.arb(2) ** -52, flint.arb(2) ** -1000
FLOAT: Rounding = lambda op, size: size * _UNIT + _LEAST  # noqa: E731


def _fmpq(x: Fraction) -> flint.fmpq:
    """Return flint's rational, whose differences take a tenth of the time."""
    return flint.fmpq(x.numerator, x.denominator)


def analyse(
    program: StepProgram,
    live: Sequence[int],
    inputs: Mapping[str, RoundedValue],
    rounding: Rounding,
    limit: Ball | None = None,
) -> dict[int, RoundedValue] | None:
    """Return each live operation's value over the inputs' intervals; None if one may be
    undefined.

    `limit`, for inputs without an error: if a function may leave a range, its values are taken
    to be within ±limit, since the kernel's guard ends the loop otherwise.
    """
    values: dict[int, RoundedValue] = {}
    for index in live:
        op = program.ops[index]
        if op.kind == "input":
            values[index] = inputs[op.name]
            continue
        if op.kind == "loop":  # how far Newton's method is from the solution is not counted
            return None
        interval, error = _value(op, [values[a] for a in op.args])
        # The kernel's guard ends the loop if such a value leaves ±limit, so larger ones need not
        # be followed.
        if limit is not None and _function(op)[0] in BALLS and not _is_within(interval, limit):
            interval = limit * flint.arb(0, 1)
        if not (interval.is_finite() and error.is_finite()):
            return None
        # The operation rounds its computed result, which is at most |interval| + error in size.
        rounding_error = rounding(op, interval.abs_upper() + error)
        values[index] = RoundedValue(interval, (error + rounding_error).abs_upper())
    return values


def _is_within(interval: Ball, limit: Ball) -> bool:
    """Return True if the interval lies in (−limit, limit)."""
    return bool(interval.is_finite() and abs(interval) < limit)


def _value(op: Op, args: Sequence[RoundedValue]) -> tuple[Ball, Ball]:
    """Return the interval of the exact result, and the error caused by the errors of the
    arguments."""
    zero = flint.arb(0)
    match op.kind:
        case "const":
            return flint.arb(_fmpq(op.value)), zero
        case "pi":
            return flint.arb.pi(), zero
        case "neg":
            return -args[0].interval, args[0].error
        case "add" | "sub":
            x, y = args
            total = x.interval + y.interval if op.kind == "add" else x.interval - y.interval
            return total, x.error + y.error
        case "mul":
            x, y = args
            # |x̂ŷ − xy| ≤ |x||ŷ − y| + |y||x̂ − x| + |x̂ − x||ŷ − y|.
            error = x.size * y.error + y.size * x.error + x.error * y.error
            if op.args[0] == op.args[1]:
                return square(x.interval), error
            return x.interval * y.interval, error
    x = args[0]
    kind, degree = _function(op)
    value = BALLS[kind](x.interval, degree)
    if x.error.is_zero():  # of no matter then is a slope without a bound
        return value, zero
    # By the mean value theorem, with the slope over an interval that holds x and x̂.
    return value, _slope(kind, degree, x.computed_interval).abs_upper() * x.error


def _function(op: Op) -> tuple[str, int]:
    """Return the kind of a function among `BALLS`, and a root's degree."""
    if op.kind == "call":
        return op.function.name, 1
    return op.kind, op.degree if op.kind == "root" else 1


def _slope(kind: str, degree: int, x: Ball) -> Ball:
    """Return a ball that holds the slopes of a function at x, or a bound on them."""
    if kind == "inverse":
        return square(1 / x)
    # The slope of x^(1/n) is x^(1/n)/(n x), which a ball around 0 makes infinite: then None is
    # returned.
    if kind == "root":
        return x.root(degree) / (degree * x)
    function = in_rings()[kind]
    if function.lipschitz is not None:
        return flint.arb(function.lipschitz)
    slope: Ball = function.derivative(x, BALLS[kind](x, 1), _apply)
    return slope


def _apply(name: str, x: Ball) -> Ball:
    return x.sqrt() if name == "sqrt" else BALLS[name](x, 1)
