"""Linear stability: for which hω > 0 a scheme stays bounded on the harmonic oscillator.

For H = (p² + ω²q²)/2, in the coordinates (p, ωq), a step of one of our schemes is a real 2 × 2
matrix M(y), y = hω, with polynomials or rational functions of y as entries. With d = det M and
t = tr M its eigenvalues are at most 1 in size exactly where 1 − d, 1 + d − t and 1 + d + t are all
≥ 0 (Jury's conditions; for `lieη`, d = |R_η(iy)|² with the truncated exponential R_η). Where they
are > 0, or d = 1 and |t| < 2, powers of M stay bounded. Where d = 1 and |t| = 2 they do so for
M = ±I alone, and else grow like a shear's; that is why a splitting's interval does not hold Y.

The interval is (0, Y) with the greatest Y such that all three hold in it; there is none where M is
a shear, or its negative, for all y. Their signs between their roots are decided exactly: by
isolating the real roots of integer polynomials.

The matrix of a composition on the harmonic oscillator, as a product of those of its parts.

A part moves (p, q) by a 2 × 2 matrix whose entries are polynomials in h, with numbers of the ring
as coefficients. Their product has as many terms as the step has parts, while p' and q' as a closed
form may have exponentially many on the way. Where the numbers are algebraic, resultants with their
relations, the newest generator first, take a polynomial in h to one over the integers that has all
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
from verify.effort import MOST, limited
from verify.errors import InputError
from verify.prose import Prose
from verify.schemes.maps.closed_form import h_inside
from verify.schemes.maps.parts import parts_of
from verify.schemes.maps.step_map import StepMap
from verify.studies.stability.positive_roots import PositiveRoot, positive_roots

_BITS = 128
_MOST_DEGREE = 600  # of the polynomial over the integers, as it may be; its roots take seconds
Entries = tuple[Poly, Poly, Poly, Poly]  # ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q


@dataclass(frozen=True)
class RingPolynomial:
    """A polynomial in h that is not 0, its coefficients algebraic numbers of the ring;
    `over_integers` has all of its roots."""

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
    parts = parts_of(step)
    if parts is None:
        return None
    ring = parts[0].ring
    if len(parts) * math.prod(power for _, power, _ in ring.relations) > _MOST_DEGREE:
        return None
    total: Entries = (ring.one, ring.zero, ring.zero, ring.one)
    for part in parts:
        own = [entry for row in part.jacobian for entry in row]
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


Y = sympy.Symbol("y", positive=True)


@dataclass(frozen=True)
class LinearStability:
    """`interval`: the Y of (0, Y), 0 where there is none, ∞ where there is no end.

    Y is a formula where it is written with square roots, else a certain root of a polynomial; or a
    number, where the scheme's coefficients are (`verify.studies.stability.nearby_linear`).
    `delta_j`: det M − 1 as a function of y. `gaps`: a y in each that was passed over.
    """

    scheme: str
    interval: "sympy.Expr | PositiveRoot | NearbyLimit"
    delta_j: sympy.Expr
    gaps: tuple[Fraction, ...] = ()

    @property
    def exact(self) -> str:
        """As a formula, or as a certain root of a polynomial."""
        if isinstance(self.interval, PositiveRoot):
            return self.interval.written(Y.name)
        if isinstance(self.interval, NearbyLimit):
            return ""
        return "infinite" if self.interval is sympy.oo else str(self.interval)

    @property
    def note(self) -> Prose:
        """Of which coefficients it is, where those of the scheme are printed."""
        return self.interval.said if isinstance(self.interval, NearbyLimit) else Prose()

    def decimal(self, digits: int = 30) -> str:
        """Rounded to so many significant digits, those that are known."""
        if isinstance(self.interval, PositiveRoot | NearbyLimit):
            return self.interval.decimal(digits)
        if self.interval in (sympy.oo, 0):
            return self.exact
        return str(self.interval.evalf(digits))


@dataclass(frozen=True)
class NearbyLimit:
    """What the digits of printed coefficients tell of the interval's end, and what is said of it;
    `radius` is an estimate."""

    value: Fraction
    radius: Fraction
    said: Prose

    def decimal(self, digits: int) -> str:
        """The digits that are known, so many at most."""
        return format(Decimal(known_text(self.value, self.radius, digits)), "f")


def of_map(
    name: str, step: StepMap, narrow: Fraction = Fraction(0), keeps_area: bool = False
) -> LinearStability:
    """The stability interval in y of a step map of H = (p² + q²)/2, with h for y; with `narrow`,
    gaps that are less wide, in parts of y, are passed over; with `keeps_area`, det M is taken to
    be 1 but for what digits leave.

    Raises InputError where it has no closed form there.
    """
    with limited("scheme", name, "its linear theory", 10 * MOST):  # `lie99` takes 3
        found = _of_product(name, step, narrow) if step.formulas is None else None
        return found or _of_closed_form(name, step, narrow, keeps_area)


def _of_product(name: str, step: StepMap, narrow: Fraction) -> LinearStability | None:
    """By the matrices of the parts; None where they have no product (`product`)."""
    found = product(step)
    if found is None:
        return None
    ring, (a, b, c, e) = found
    trace, more = ring.reduce(a + e), ring.reduce(a * e - b * c - ring.one)  # more is ΔJ
    signs = [-more, more + 2 - trace, more + 2 + trace]
    vanish = [ring.vanishes(x) for x in signs]
    conditions = [ring_polynomial(ring, x) for x, v in zip(signs, vanish, strict=True) if not v]
    known = [f for f in conditions if f is not None]
    if None in vanish or len(known) < len(conditions):
        return None
    shears = vanish[0] and (vanish[1] or vanish[2])
    moves = any(ring.vanishes(x) is not True for x in (b, c))
    interval, gaps = (sympy.S.Zero, ()) if shears and moves else _interval(known, narrow)
    delta_j = ring.expression(more).subs(H_STEP, Y)
    return LinearStability(name, interval, sympy.factor(delta_j), gaps)


def _of_closed_form(
    name: str, step: StepMap, narrow: Fraction, keeps_area: bool
) -> LinearStability:
    entries = [sympy.together(x.subs(H_STEP, Y)) for x in step.jacobian]
    if any(x.free_symbols - {Y} for x in entries):
        raise InputError("scheme", name, "is not linear on the harmonic oscillator")
    a, b, c, e = entries
    det, trace = (sympy.cancel(x) for x in (a * e - b * c, a + e))
    of_area = () if keeps_area else (1 - det,)
    conditions = [_polynomial(x) for x in (*of_area, 1 + det - trace, 1 + det + trace)]
    interval, _ = _interval([_SympyPolynomial(f) for f in conditions if not f.is_zero], narrow)
    if det == 1 and trace in (2, -2) and any(sympy.cancel(x) != 0 for x in (b, c)):
        interval = sympy.S.Zero
    return LinearStability(name, interval, sympy.factor(det - 1))


@dataclass(frozen=True)
class _SympyPolynomial:
    """As a `RingPolynomial`, of what sympy has in closed form."""

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
    """A polynomial of x's sign at every y > 0 that is no pole."""
    above, below = sympy.fraction(sympy.cancel(x))
    return sympy.Poly(sympy.expand(above * below), Y, extension=True)


def _interval(
    conditions: Sequence[RingPolynomial] | Sequence[_SympyPolynomial],
    narrow: Fraction = Fraction(0),
) -> tuple[sympy.Expr | PositiveRoot, tuple[Fraction, ...]]:
    """The greatest Y such that all of them, of which none is 0, are ≥ 0 on (0, Y), and a y in each
    gap passed over."""
    left: PositiveRoot | None = None
    above, gaps = Fraction(0), list[Fraction]()  # the end of what encloses `left`
    for root, (low, high) in positive_roots(f.over_integers for f in conditions):
        middle = (above + low) / 2
        if any(f.is_negative(middle) for f in conditions):
            if left is None or low - above >= narrow * low:
                break
            gaps.append(middle)
        left, above = root, high
    else:
        if not any(f.is_negative(above + 1) for f in conditions):
            return sympy.oo, tuple(gaps)
    return sympy.S.Zero if left is None else left.closed_form() or left, tuple(gaps)
