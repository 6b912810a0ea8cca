"""The order that a map of the plane has but for the rounding of its coefficients.

Yoshida's 1.3512071919596578 is not 1/(2 − 2^(1/3)): taken by its exact value it gives a map of
order 0, whose first Taylor coefficients miss those of the flow by 10⁻¹⁶. Such residues are told
from errors by their size beside the coefficients that they are residues of.
"""

import math
from fractions import Fraction

from verify.algebra.series.power_series import Series
from verify.hamiltonians.vector_field import VectorField
from verify.proof.order import size_of

_ROUNDING = Fraction(1, 2**44)


def rounded_order(field: VectorField, p: Series, q: Series) -> int | None:
    """Up to which power of h it agrees with the flow, with residues below 2⁻⁴⁴ of the coefficients
    taken for 0; None where it does in all that are looked at."""
    scale = Fraction(0)
    for n in range(p.most + 1):
        gap = Fraction(0)
        for series, name in ((p, "p"), (q, "q")):
            x, y = series.coefficients[n], field.power(name, n) / math.factorial(n)
            gap = max(gap, size_of(field.ring.reduce(x - y)))
            scale = max(scale, size_of(x), size_of(y))
        if gap > _ROUNDING * scale:
            return n - 1
    return None
