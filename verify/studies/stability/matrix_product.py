"""The matrix of a composition on the harmonic oscillator, as a product of those of its parts.

A part moves (p, q) by a 2 × 2 matrix whose entries are polynomials in h, with numbers of the ring
as coefficients. Their product has as many terms as the step has parts, while p' and q' as a closed
form may have exponentially many on the way. Where the numbers are algebraic, resultants with their
relations, the newest generator first, take a polynomial in h to one over the integers that has all
of its roots: the resultant of r and f in a generator vanishes where both have a common root in it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.schemes.step_map import StepMap
from verify.schemes.substep import h_inside

_BITS = 128
_MOST_DEGREE = 600  # of the polynomial over the integers, as it may be; its roots take seconds
Entries = tuple[Poly, Poly, Poly, Poly]  # ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q


@dataclass(frozen=True)
class RingPolynomial:
    """A polynomial in h that is not 0, its coefficients algebraic numbers of the ring."""

    ring: Ring
    element: Poly
    over_integers: flint.fmpz_poly

    def is_negative(self, h: Fraction) -> bool:
        """Its sign there; h must be no root of `over_integers`."""
        bits = _BITS
        point = {"p": Fraction(0), "q": Fraction(0), "h": h}
        while True:
            ball = enclose(self.ring, self.element, point, bits)
            if ball is not None and (ball < 0 or ball > 0):
                return bool(ball < 0)
            bits *= 2


def product(step: StepMap) -> tuple[Ring, Entries] | None:
    """The matrix of the whole step; None where its parts are not as the module says.

    None, too, where there are so many of them, of so high a degree, that roots would take minutes.
    """
    field = step.substeps[0].field
    ring = field.ring
    if step.implicit or any(part.field is not field for part in step.substeps):
        return None
    if len(step.substeps) * math.prod(power for _, power, _ in ring.relations) > _MOST_DEGREE:
        return None
    total: Entries = (ring.one, ring.zero, ring.zero, ring.one)
    for part in step.substeps:
        own = [ring.diff(x, name) for x in (part.p_next, part.q_next) for name in ("p", "q")]
        if h_inside(ring, *own) or any(ring.depends(x, name) for x in own for name in ("p", "q")):
            return None
        total = _times(ring, own, total)
    return ring, total


def ring_polynomial(ring: Ring, x: Poly) -> RingPolynomial | None:
    """x, which is not 0, with its polynomial over the integers; None where it has none."""
    norm = x
    for index, _, relation in reversed(ring.relations):
        if norm.degrees()[index] > 0:
            norm = relation.resultant(norm, index)
    if norm.is_zero() or not ring.in_variables(norm):  # π has no relation
        return None
    powers = ring.powers(norm, "h")
    degree = max(powers)
    coefficients = [powers.get(n, ring.zero) for n in range(degree + 1)]
    if not all(c.is_constant() for c in coefficients):
        return None
    numbers = [c.leading_coefficient() if not c.is_zero() else flint.fmpq(0) for c in coefficients]
    return RingPolynomial(ring, x, flint.fmpq_poly(numbers).numer())


def _times(ring: Ring, left: Sequence[Poly], right: Entries) -> Entries:
    a, b, c, d = left
    e, f, g, h = right
    return (
        ring.reduce(a * e + b * g),
        ring.reduce(a * f + b * h),
        ring.reduce(c * e + d * g),
        ring.reduce(c * f + d * h),
    )
