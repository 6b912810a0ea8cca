"""The exact flow in n degrees of freedom by high-order Taylor steps, twice: as
`verify.reference.check.exact_flow` in the plane, an estimate."""

import math
from collections.abc import Mapping
from fractions import Fraction

import flint

from verify.reference.check.exact_flow import largest, power_of_two
from verify.reference.check.taylor import number
from verify.reference.check.textbook import polynomial
from verify.reference.check.textbook_in_degrees import FieldInDegrees, Vector, flow_series

_MORE = 8  # digits, and orders, of the second integration
_MOST_STEPS = 2_000


def state_at(
    field: FieldInDegrees, start: Mapping[str, Fraction], time: Fraction, digits: int
) -> Vector | None:
    """Balls of z at the time; None where the solution is not followed so far.

    `start`: the coordinates and, where H depends on it, t.
    """
    with flint.ctx.workprec(math.ceil(3.33 * (digits + _MORE)) + 64):
        rough = _followed(field, start, time, digits)
        fine = _followed(field, start, time, digits + _MORE)
        if rough is None or fine is None:
            return None
        apart = flint.arb(0)
        for a, b in zip(rough, fine, strict=True):
            apart = apart.max(abs(a - b))
        scale = flint.arb(0)
        for x in fine:
            scale = scale.max(abs(x))
        radius = 4 * apart + scale * flint.arb(10) ** (-digits - 2)
        return [x.mid() + flint.arb(0, 1) * radius for x in fine]


def _followed(
    field: FieldInDegrees, start: Mapping[str, Fraction], time: Fraction, digits: int
) -> Vector | None:
    order = digits + digits // 4 + 10
    z: Vector = [flint.arb(number(start[name])) for name in field.names]
    done = Fraction(0)
    for _ in range(_MOST_STEPS):
        if done == time:
            return z
        t = flint.arb(number(start.get("t", Fraction(0)) + done))
        zs = flow_series(field, z, t, order)
        if not all(x.is_finite() for x in zs[-1]):
            return None
        after = min(time, done + power_of_two(_reach(zs, digits)))
        h = flint.arb(number(after - done))
        z = [polynomial([x[k] for x in zs], h).mid() for k in range(len(z))]
        done = after
    return None


def _reach(zs: list[Vector], digits: int) -> float:
    """lg₂ of a step whose last terms are 10^−digits of the state, or of its speed where it is 0."""
    scale = next((size for size in map(largest, zs) if size > -math.inf), 0.0)
    found = []
    for k in (len(zs) - 1, len(zs) - 2):
        last = largest(zs[k])
        if last > -math.inf:
            found.append((scale - 3.3219281 * digits - last) / k)
    return min(found, default=60.0)  # a polynomial in t
