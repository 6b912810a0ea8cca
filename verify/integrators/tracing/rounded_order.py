"""The orders that a map has but for the rounding of its coefficients.

Yoshida's 1.3512071919596578 is not 1/(2 − 2^(1/3)): taken by its exact value it gives a map of
order 0, whose first Taylor coefficients miss those of the flow by 10⁻¹⁶. Such residues are told
from errors by their size beside the coefficients that they are residues of.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

from verify.algebra.ring import Poly
from verify.algebra.series.power_series import Series, delta_j
from verify.hamiltonians.vector_field import VectorField

ROUNDING = Fraction(1, 2**44)


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


def rounded_orders(field: VectorField, p: Series, q: Series) -> Rounded:
    ring, most = field.ring, p.most
    residue, scale = Fraction(0), Fraction(0)
    convergence: int | None = None
    for n in range(most + 1):
        gap = Fraction(0)
        for own, name in ((p, "p"), (q, "q")):
            flow = field.power(name, n) / math.factorial(n)
            x = own.coefficients[n]
            gap = max(gap, size_of(ring.reduce(x - flow)))
            scale = max(scale, size_of(x), size_of(flow))
        if gap > ROUNDING * scale:
            convergence = n - 1
            break
        residue = max(residue, gap)
    for n, x in enumerate(delta_j(p, q).coefficients):
        if size_of(x) > ROUNDING * scale:
            return Rounded(convergence, n, residue, x)
        residue = max(residue, size_of(x))
    return Rounded(convergence, None, residue, None)


def size_of(x: Poly) -> Fraction:
    """The largest coefficient."""
    return max((abs(Fraction(int(c.p), int(c.q))) for c in x.coeffs()), default=Fraction(0))
