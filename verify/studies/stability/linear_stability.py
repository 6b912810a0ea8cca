"""Linear stability: the interval of hω in which a scheme stays bounded on the harmonic oscillator.

For H = (p² + ω²q²)/2, in the coordinates (p, ωq), a step of one of our schemes is a real 2 × 2
matrix M(y), y = hω, with polynomials or rational functions of y as entries. With d = det M and
t = tr M its eigenvalues are at most 1 in size exactly where 1 − d, 1 + d − t and 1 + d + t are all
≥ 0 (Jury's conditions; for `lieη`, d = |R_η(iy)|² with the truncated exponential R_η). Where they
are > 0, or d = 1 and |t| < 2, powers of M stay bounded. Where d = 1 and |t| = 2 they do so for
M = ±I alone, and else grow like a shear's; that is why a splitting's interval does not hold Y.

The interval is (0, Y) with the greatest Y such that all three conditions hold in it; there is none
if M is a shear, or its negative, for all y. The conditions' signs between their roots are decided
exactly, by isolating the real roots of integer polynomials.

M of a composition is the product of the matrices of its parts. A part moves (p, q) by a 2 × 2
matrix whose entries are polynomials in h, with numbers of the ring as coefficients. The degree of
the product grows with the number of parts, while p' and q' as a closed form may have exponentially
many terms on the way. If the numbers are algebraic, resultants with the relations of the ring's
generators, the newest generator first, take a polynomial in h to one over the integers that has all
of its roots: the resultant of r and f in a generator vanishes where both have a common root in it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import flint
import sympy

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.algebra.symbols import H_STEP
from verify.arithmetic.exact import known_text
from verify.effort import MAX_CALLS, limit_effort
from verify.errors import InputError
from verify.prose import Prose
from verify.schemes.maps.closed_form import h_inside
from verify.schemes.maps.parts import parts_of
from verify.schemes.maps.step_map import StepMap
from verify.studies.stability.positive_roots import PositiveRoot, positive_roots

_BITS = 128
_MAX_DEGREE = 600  # an estimate of that over the integers; its roots then take seconds
Entries = tuple[Poly, Poly, Poly, Poly]  # ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q


@dataclass(frozen=True)
class RingPolynomial:
    """A polynomial in h that is not 0, its coefficients algebraic numbers of the ring;
    `over_integers` has all of its roots."""

    ring: Ring
    element: Poly
    over_integers: flint.fmpz_poly

    def is_negative(self, h: Fraction) -> bool:
        """Return True if it is negative at h, which must be no root of `over_integers`."""
        bits = _BITS
        point = {"p": Fraction(0), "q": Fraction(0), "h": h}
        while True:
            ball = enclose(self.ring, self.element, point, bits)
            if ball is not None and (ball < 0 or ball > 0):
                return bool(ball < 0)
            bits *= 2


def matrix_of_step(step: StepMap) -> tuple[Ring, Entries] | None:
    """Return the matrix of the whole step; None if its parts are not polynomials in h.

    None, too, if there are so many parts, of so high a degree, that roots would take minutes.
    """
    parts = parts_of(step)
    if parts is None:
        return None
    ring = parts[0].ring
    if len(parts) * math.prod(power for _, power, _ in ring.relations) > _MAX_DEGREE:
        return None
    total: Entries = (ring.one, ring.zero, ring.zero, ring.one)
    for part in parts:
        entries = [entry for row in part.jacobian for entry in row]
        if h_inside(ring, *entries) or any(
            ring.depends(x, name) for x in entries for name in ("p", "q")
        ):
            return None
        total = _multiply(ring, entries, total)
    return ring, total


def ring_polynomial(ring: Ring, x: Poly) -> RingPolynomial | None:
    """Return x, which is not 0, with its polynomial over the integers; None if it has none."""
    # The resultant with a relation eliminates its generator; the newest one is eliminated first.
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


def _multiply(ring: Ring, left: Sequence[Poly], right: Entries) -> Entries:
    a, b, c, d = left
    e, f, g, h = right
    return (
        ring.reduce(a * e + b * g),
        ring.reduce(a * f + b * h),
        ring.reduce(c * e + d * g),
        ring.reduce(c * f + d * h),
    )


Y = sympy.Symbol("y", positive=True)


@dataclass(frozen=True)
class LinearStability:
    """The stability interval (0, Y) of a scheme; `interval` is Y, 0 for none, ∞ for no end.

    Y is a formula with square roots if it has one, else a root of a polynomial, by its number; or,
    if the scheme's coefficients are printed decimals, a number with a radius
    (`verify.studies.stability.scheme_interval`). `delta_j`: det M − 1 as a function of y. `gaps`: a
    y in each gap of the interval that was passed over.
    """

    scheme: str
    interval: "sympy.Expr | PositiveRoot | NearbyLimit"
    delta_j: sympy.Expr
    gaps: tuple[Fraction, ...] = ()

    @property
    def exact(self) -> str:
        """The end of the interval as a formula or a root of a polynomial; empty for a number."""
        if isinstance(self.interval, PositiveRoot):
            return self.interval.describe(Y.name)
        if isinstance(self.interval, NearbyLimit):
            return ""
        return "infinite" if self.interval is sympy.oo else str(self.interval)

    @property
    def note(self) -> Prose:
        """The coefficients that it belongs to, where those of the scheme are printed."""
        return self.interval.note if isinstance(self.interval, NearbyLimit) else Prose()

    def decimal(self, digits: int = 30) -> str:
        """Return the end rounded to so many significant digits, as far as they are known."""
        if isinstance(self.interval, PositiveRoot | NearbyLimit):
            return self.interval.decimal(digits)
        if self.interval in (sympy.oo, 0):
            return self.exact
        return str(self.interval.evalf(digits))


@dataclass(frozen=True)
class NearbyLimit:
    """The end of the interval as far as the digits of printed coefficients determine it.

    `radius` is an estimate; `note` describes the coefficients.
    """

    value: Fraction
    radius: Fraction
    note: Prose

    def decimal(self, digits: int) -> str:
        """Return the value to the digits that are certain, `digits` at most."""
        return format(Decimal(known_text(self.value, self.radius, digits)), "f")


def stability_of_map(
    name: str, step: StepMap, narrow: Fraction = Fraction(0), keeps_area: bool = False
) -> LinearStability:
    """Return the stability interval in y of a step map of H = (p² + q²)/2, with h for y.

    `narrow`: gaps whose width, relative to y, is less than this are passed over. `keeps_area`: det
    M is taken to be 1, from which it differs by the rounding of printed digits.

    Raises InputError if the step has no closed form on the oscillator.
    """
    # `lie99` takes 3 · MAX_CALLS.
    with limit_effort("scheme", name, "its linear theory", 10 * MAX_CALLS):
        stability = _stability_by_product(name, step, narrow) if step.formulas is None else None
        return stability or _stability_by_closed_form(name, step, narrow, keeps_area)


def _stability_by_product(name: str, step: StepMap, narrow: Fraction) -> LinearStability | None:
    """Return the stability by the matrices of the parts; None if `matrix_of_step` has none."""
    matrix = matrix_of_step(step)
    if matrix is None:
        return None
    ring, (a, b, c, e) = matrix
    trace, delta_j_element = ring.reduce(a + e), ring.reduce(a * e - b * c - ring.one)
    # Jury's conditions 1 − d, 1 + d − t and 1 + d + t, with d = 1 + `delta_j_element`.
    signs = [-delta_j_element, delta_j_element + 2 - trace, delta_j_element + 2 + trace]
    vanish = [ring.vanishes(x) for x in signs]
    conditions = [ring_polynomial(ring, x) for x, v in zip(signs, vanish, strict=True) if not v]
    polynomials = [f for f in conditions if f is not None]
    if None in vanish or len(polynomials) < len(conditions):
        return None
    # det M = 1 and tr M = ±2 for all y: M is ±I or a shear, which the entries off the diagonal
    # decide.
    shears = vanish[0] and (vanish[1] or vanish[2])
    moves = any(ring.vanishes(x) is not True for x in (b, c))
    interval, gaps = (sympy.S.Zero, ()) if shears and moves else _find_interval(polynomials, narrow)
    delta_j = ring.expression(delta_j_element).subs(H_STEP, Y)
    return LinearStability(name, interval, sympy.factor(delta_j), gaps)


def _stability_by_closed_form(
    name: str, step: StepMap, narrow: Fraction, keeps_area: bool
) -> LinearStability:
    entries = [sympy.together(x.subs(H_STEP, Y)) for x in step.jacobian]
    if any(x.free_symbols - {Y} for x in entries):
        raise InputError("scheme", name, "is not linear on the harmonic oscillator")
    a, b, c, e = entries
    det, trace = (sympy.cancel(x) for x in (a * e - b * c, a + e))
    of_area = () if keeps_area else (1 - det,)
    conditions = [_polynomial(x) for x in (*of_area, 1 + det - trace, 1 + det + trace)]
    interval, _ = _find_interval([_SympyPolynomial(f) for f in conditions if not f.is_zero], narrow)
    if det == 1 and trace in (2, -2) and any(sympy.cancel(x) != 0 for x in (b, c)):
        interval = sympy.S.Zero
    return LinearStability(name, interval, sympy.factor(det - 1))


@dataclass(frozen=True)
class _SympyPolynomial:
    """A polynomial as `RingPolynomial`, from a closed form of sympy."""

    f: sympy.Poly

    @property
    def over_integers(self) -> flint.fmpz_poly:
        f = self.f.norm() if self.f.domain.is_Algebraic else self.f
        return flint.fmpq_poly(
            [flint.fmpq(int(x.p), int(x.q)) for x in f.all_coeffs()[::-1]]
        ).numer()

    def is_negative(self, y: Fraction) -> bool:
        return bool(self.f.eval(sympy.Rational(y.numerator, y.denominator)) < 0)


def _polynomial(x: sympy.Expr) -> sympy.Poly:
    """Return a polynomial that has the sign of x at every y > 0 that is no pole."""
    above, below = sympy.fraction(sympy.cancel(x))
    return sympy.Poly(sympy.expand(above * below), Y, extension=True)


def _find_interval(
    conditions: Sequence[RingPolynomial] | Sequence[_SympyPolynomial],
    narrow: Fraction = Fraction(0),
) -> tuple[sympy.Expr | PositiveRoot, tuple[Fraction, ...]]:
    """Return the greatest Y such that all conditions are ≥ 0 on (0, Y), and a y in each gap.

    No condition may be constantly 0. The gaps are those that were passed over.
    """
    end: PositiveRoot | None = None
    # `above`: the upper end of the last root's enclosure.
    above, gaps = Fraction(0), list[Fraction]()
    for root, (low, high) in positive_roots(f.over_integers for f in conditions):
        # No condition changes its sign between two roots, so that one point decides a whole gap.
        middle = (above + low) / 2
        if any(f.is_negative(middle) for f in conditions):
            if end is None or low - above >= narrow * low:
                break
            gaps.append(middle)
        end, above = root, high
    else:
        if not any(f.is_negative(above + 1) for f in conditions):
            return sympy.oo, tuple(gaps)
    return sympy.S.Zero if end is None else end.closed_form() or end, tuple(gaps)
