"""The orders that a map has but for the rounding of its coefficients.

Yoshida's 1.3512071919596578 is not 1/(2 − 2^(1/3)): taken by its exact value it gives a map of
order 0, whose first Taylor coefficients miss those of the flow by 10⁻¹⁶. Such residues are told
from errors by their size beside the coefficients that they are residues of.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from verify.algebra.ring import Poly
from verify.algebra.series.power_series import Series, delta_j
from verify.hamiltonians.vector_field import VectorField
from verify.proof.order import size_of

_ROUNDING = Fraction(1, 2**44)


@dataclass(frozen=True)
class Rounded:
    """`convergence`, `area`: the powers of h as of a proof, with residues below 2⁻⁴⁴ of the
    coefficients taken for 0; None where all that are looked at vanish so. `residue`: the largest of
    what was taken for 0. `leading`: the first coefficient of ΔJ that was not.
    """

    convergence: int | None
    area: int | None
    residue: Fraction
    leading: Poly | None


@dataclass(frozen=True)
class Agreement:
    """`order`: up to which power of h two series agree so, None in all that were looked at;
    `residue`: the largest of what was taken for 0, beside coefficients of the size `scale`."""

    order: int | None
    residue: Fraction
    scale: Fraction


Compared = tuple[Poly, Poly, Poly]  # a coefficient, the flow's, and their difference in normal form


def agreement(coefficients: Iterable[Iterable[Compared]]) -> Agreement:
    """Of the coefficients of h⁰, h¹, …, each of all components."""
    residue, scale = Fraction(0), Fraction(0)
    for n, components in enumerate(coefficients):
        gap = Fraction(0)
        for x, y, difference in components:
            gap = max(gap, size_of(difference))
            scale = max(scale, size_of(x), size_of(y))
        if gap > _ROUNDING * scale:
            return Agreement(n - 1, residue, scale)
        residue = max(residue, gap)
    return Agreement(None, residue, scale)


def rounded_orders(field: VectorField, p: Series, q: Series) -> Rounded:
    """Those of a map of the plane."""

    def compared(n: int) -> Iterator[Compared]:
        for own, name in ((p, "p"), (q, "q")):
            x, y = own.coefficients[n], field.power(name, n) / math.factorial(n)
            yield x, y, field.ring.reduce(x - y)

    found = agreement(map(compared, range(p.most + 1)))
    convergence, residue, scale = found.order, found.residue, found.scale
    for n, x in enumerate(delta_j(p, q).coefficients):
        if size_of(x) > _ROUNDING * scale:
            return Rounded(convergence, n, residue, x)
        residue = max(residue, size_of(x))
    return Rounded(convergence, None, residue, None)
