"""Whether a ring element is the zero function, and a witness if it is not; see
`verify.algebra.ring`.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.enclosure import enclose, points
from verify.algebra.generator import Poly

_FIRST_POINTS = 4
_PRECISIONS = (64, 256, 1024)  # bits tried when looking for a witness


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
    names = [g.name for g in ring.generators_in(x) if g.kind == "variable"]
    # A point usually tells at once; clearing denominators can be long work.
    found = _witness(ring, x, islice(points(names), _FIRST_POINTS), _PRECISIONS[0])
    if found is None and clear_inverses(ring, x).is_zero():
        return Decision(True)
    for precision in _PRECISIONS:
        found = found or _witness(ring, x, points(names), precision)
    return found or Decision(None)


def _witness(
    ring: DifferentialRing, x: Poly, at: Iterable[dict[str, Fraction]], precision: int
) -> Decision | None:
    for point in at:
        value = enclose(ring, x, point, precision)
        if value is not None and not value.contains(0):
            return Decision(False, point, value.str(12))
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
