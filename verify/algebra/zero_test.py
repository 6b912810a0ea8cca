"""Whether a ring element is the zero function, and a witness if it is not; see
`verify.algebra.ring`.

Where neither its normal form nor a point decides, the element is translated to a field of functions
in which more identities show:
- cosines and sines are expanded over parts of angles, rational multiples of π being split off, and
  hyperbolic functions are of exponentials;
- roots and logarithms are those of irreducible factors, as |·|^r and log |·| are homomorphisms;
- numbers are told from 0 by a bound from below (`identities.numbers`).
What is then not 0 yet may be by a relation between logarithms or between arctangents
(`identities.relations`), or between square roots (`identities.conjugates`). Every step is an
identity of functions wherever the element is defined; a zero that is defined nowhere is none.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.enclosure import Ball, Enclosures, enclose, points
from verify.algebra.generator import Poly
from verify.algebra.identities.conjugates import vanishes_by_conjugates
from verify.algebra.identities.field import Names, UndecidedError
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.relations import without_related
from verify.algebra.identities.translation import Translation, translated
from verify.algebra.where_positive import is_convex, point_of

_FIRST_POINTS = 4
_PRECISIONS = (64, 256, 1024)  # bits tried when looking for a witness
_MOST_ENCLOSED = 80_000  # terms, at all points looked at with one precision

Value = Callable[[Mapping[str, Fraction], int], Ball | None]  # of a point and bits
_WAVES = {"sin", "cos"}
_OF_FACTORS = {"root", "log"}


@dataclass(frozen=True)
class Decision:
    """Whether an element is zero: True, False or None (undecided), with the witness of False."""

    zero: bool | None
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""


def decided(ring: DifferentialRing, x: Poly) -> Decision:
    """Of x in normal form."""
    if x.is_zero():
        return Decision(True)
    used = ring.generators_in(x)
    names = [g.name for g in used if g.kind == "variable"]
    # A point usually tells at once; clearing denominators can be long work.
    value = _values(ring, x)
    found = _witness(value, islice(points(names), _FIRST_POINTS), _PRECISIONS[0])
    if found is None and (clear_inverses(ring, x).is_zero() or _is_hidden(ring, x)):
        return Decision(True)
    terms = len(x) + sum(len(g.argument) for g in used if g.argument is not None)
    most = max(_FIRST_POINTS, _MOST_ENCLOSED // terms)
    for precision in _PRECISIONS:
        found = found or _witness(value, islice(points(names), most), precision)
    return found or Decision(None)


def _values(ring: DifferentialRing, x: Poly) -> Value:
    """Encloses x at a point; exactly, where it is a polynomial in the variables."""
    if ring.in_variables(x):
        return lambda point, precision: enclose(ring, x, point, precision)
    enclosures = Enclosures(ring, [x])

    def value(point: Mapping[str, Fraction], precision: int) -> Ball | None:
        balls = enclosures.at(point, precision)
        return None if balls is None else balls[0]

    return value


def _witness(value: Value, at: Iterable[dict[str, Fraction]], precision: int) -> Decision | None:
    for point in at:
        ball = value(point, precision)
        if ball is not None and not ball.contains(0):
            return Decision(False, point, ball.str(12))
    return None


def clear_inverses(ring: DifferentialRing, x: Poly) -> Poly:
    """x times the powers of denominators that remove every inverse, in normal form."""
    for g in reversed([g for g in ring.generators if g.kind == "inverse"]):
        parts = ring.split(x, g.index)
        highest = max(parts, default=0)
        if highest:
            total = ring.zero
            for power in range(highest + 1):  # Horner's rule in the denominator
                total = ring.reduce(total * g.inner) if power else total
                total += parts.get(power, ring.zero)
            x = ring.reduce(total)
    return x


def _is_hidden(ring: DifferentialRing, x: Poly) -> bool:
    """True where x is shown to be 0 wherever it is defined; else False, which says nothing."""
    point = point_of(ring, x)
    if point is None:
        return False
    kinds = {g.kind for g in ring.generators_in(x)}
    # Tangents serve to find factors, which only roots and logarithms are asked for.
    ways = (False, True) if kinds & _WAVES and kinds & _OF_FACTORS else (False,)
    return any(_is_shown(ring, x, point, tangents) for tangents in ways)


def _is_shown(ring: DifferentialRing, x: Poly, names: Names, tangents: bool) -> bool:
    try:
        return _vanishes(translated(ring.generators_in(x), x, tangents=tangents), ring, x, names)
    except UndecidedError:
        return False


def _vanishes(t: Translation, ring: DifferentialRing, x: Poly, names: Names) -> bool:
    above = t.element.above
    if vanishes(t.field, above):
        return True
    angles = [g.inner for g in t.used if g.kind == "atan"]
    left = without_related(t, above, names, lambda: is_convex(ring, angles, inside=x))
    if left != above and vanishes(t.field, left):
        return True
    return is_convex(ring, [x], inside=x) and vanishes_by_conjugates(t, left, names)
