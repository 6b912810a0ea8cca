"""The decision whether a ring element is the zero function (see `verify.algebra.ring`).

First the normal form may decide, or a witness: a point at which the element is not 0. If neither
does, the denominators are cleared, and then `verify.algebra.hidden_zero` looks further.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from itertools import islice

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.enclosure import Ball, Enclosures, enclose, points
from verify.algebra.identities.polynomials import Poly, split

_FIRST_POINTS = 4
_PRECISIONS = (64, 256, 1024)  # bits
_MAX_ENCLOSED_TERMS = 80_000  # are evaluated at one precision, over all points

Value = Callable[[Mapping[str, Fraction], int], Ball | None]  # (point, bits) → ball


@dataclass(frozen=True)
class Decision:
    """The answer whether an element is zero: True, False with a witness, or None (undecided)."""

    zero: bool | None
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""


def decide_zero(ring: DifferentialRing, x: Poly) -> Decision:
    """Decide whether x, which is in normal form, is the zero function."""
    if x.is_zero():
        return Decision(True)
    generators = ring.generators_in(x)
    names = [g.name for g in generators if g.kind == "variable"]
    # A point usually decides at once; clearing denominators can take long.
    value = _values(ring, x)
    decision = witness(value, islice(points(names), _FIRST_POINTS), _PRECISIONS[0])
    if decision is None and (clear_inverses(ring, x).is_zero() or _is_hidden(ring, x)):
        return Decision(True)
    terms = len(x) + sum(len(g.argument) for g in generators if g.argument is not None)
    most = max(_FIRST_POINTS, _MAX_ENCLOSED_TERMS // terms)
    # Points near a zero need more bits, so the search is repeated with higher precision.
    for precision in _PRECISIONS:
        decision = decision or witness(value, islice(points(names), most), precision)
    return decision or Decision(None)


def _values(ring: DifferentialRing, x: Poly) -> Value:
    """Return a function that encloses x at a point; polynomials are evaluated exactly."""
    if ring.in_variables(x):
        return partial(enclose, ring, x)
    enclosures = Enclosures(ring, [x])

    def value(point: Mapping[str, Fraction], precision: int) -> Ball | None:
        balls = enclosures.enclose_at(point, precision)
        return None if balls is None else balls[0]

    return value


def witness(
    value: Value, points_to_try: Iterable[dict[str, Fraction]], precision: int
) -> Decision | None:
    """Return the decision of the first point at which the value is shown not to be 0, or None."""
    for point in points_to_try:
        ball = value(point, precision)
        if ball is not None and not ball.contains(0):
            return Decision(False, point, ball.str(12))
    return None


def clear_inverses(ring: DifferentialRing, x: Poly) -> Poly:
    """Return x times the powers of denominators that remove every inverse, in normal form."""
    for g in reversed([g for g in ring.generators if g.kind == "inverse"]):
        parts = split(x, g.index)
        highest = max(parts, default=0)
        if highest:
            total = ring.zero
            for power in range(highest + 1):  # Horner's rule in the denominator
                total = ring.reduce(total * g.inner) if power else total
                total += parts.get(power, ring.zero)
            x = ring.reduce(total)
    return x


def _is_hidden(ring: DifferentialRing, x: Poly) -> bool:
    from verify.algebra.hidden_zero import is_hidden_zero  # few elements need it

    return is_hidden_zero(ring, x)
