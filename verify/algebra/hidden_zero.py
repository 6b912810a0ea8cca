"""A ring element that is the zero function, and neither its normal form nor a point tells.

The element is translated to a field of functions in which more identities show:
- cosines and sines are expanded over parts of angles, rational multiples of π being split off, and
  hyperbolic functions are of exponentials;
- roots and logarithms are those of irreducible factors, as |·|^r and log |·| are homomorphisms;
- numbers are told from 0 by a bound from below (`identities.numbers`).
What is then not 0 yet may be by a relation between logarithms or between arctangents
(`identities.relations`), or between square roots (`identities.conjugates`). Every step is an
identity of functions wherever the element is defined; a zero that is defined nowhere is none.
"""

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.generator import Poly
from verify.algebra.identities.conjugates import vanishes_by_conjugates
from verify.algebra.identities.field import Names, UndecidedError
from verify.algebra.identities.numbers import vanishes
from verify.algebra.identities.relations import without_related
from verify.algebra.identities.translation import Translation, translated
from verify.algebra.where_positive import is_convex, point_of

_WAVES = {"sin", "cos"}
_OF_FACTORS = {"root", "log"}


def is_hidden_zero(ring: DifferentialRing, x: Poly) -> bool:
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
