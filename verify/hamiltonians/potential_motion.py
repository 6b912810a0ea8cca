"""Motion in a polynomial potential of degree up to 4, in closed form from any initial value.

H = α p²/2 + V(q) gives q'² = f(q) with f = 2α (E − V), a polynomial of degree up to 4. With its
invariants g₂ and g₃ and ℘ = ℘(t; g₂, g₃), Biermann's and Weierstrass's formula (Whittaker and
Watson, A Course of Modern Analysis, 20.6) is, for f = Σ b_k y^k in y = q − q₀, and v = q'(0),

    q(t) = q₀ + A/B,  A = −v ℘' + (b₁/2)(℘ − b₂/12) + b₀b₃/4,  B = 2 (℘ − b₂/12)² − b₀b₄/2.

It holds in every regime, has no branches, and B = 0 is where q is infinite. There (x → ∞ in the
formula's inverse) ℘ = b₂/12 + s v √b₄/2 and ℘' = −(b₃ v + s b₁ √b₄)/4, with s the sign of q'.
The b_k are exact, so that Δ = 0 (a separatrix, or elementary functions) is known and not guessed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

import sympy

from verify.arithmetic.batch import Batch
from verify.hamiltonians.motion import Context, Flow, Motion, Number, State, Values, at_rest, number
from verify.hamiltonians.potential_barriers import destinations
from verify.hamiltonians.weierstrass import Weierstrass, waves

_METHOD = "closed form: Weierstrass's ℘ by Jacobi's elliptic functions"
_ELEMENTARY = "closed form: elementary functions"


def in_potential(coefficients: Callable[[Values], Sequence[Fraction]]) -> Flow:
    """The flow of p²/2 + Σ c_k q^k, k = 0 … 4, with these coefficients."""
    return lambda values, p, q: motion(Fraction(1), coefficients(values), p, q)


def motion(alpha: Fraction, potential: Sequence[Fraction], p: Fraction, q: Fraction) -> Motion:
    """The solution for H = α p²/2 + V(q) through (p, q), α ≠ 0 and V of degree up to 4."""
    curve = Curve.through(alpha, potential, p, q)
    if curve.v == 0 and curve.b[1] == 0:
        return at_rest(p, q)
    ends = curve.degree > 2

    @cache
    def to(sign: int) -> Any:
        if curve.b[4] < 0:
            return 0  # V rises without end on both sides
        if isinstance(p, Batch):
            return destinations(alpha, potential, p, q, sign)
        return curve.destination(sign)

    def state(mp: Context, t: Number) -> State:
        y, slope = curve.at(mp, t)
        return slope / number(mp, alpha), number(mp, q) + y

    def blow_up(mp: Context, sign: int) -> Number | None:
        return curve.time_to_infinity(mp, sign, to(sign)) if ends and to(sign) else None

    def goes() -> str | None:
        if ends or not to(1):
            return None
        return f"q goes to {'+' if to(1) > 0 else '−'}∞ as t grows"

    method = _ELEMENTARY if curve.delta == 0 else _METHOD
    return Motion(state, method, curve.lost, blow_up, goes)


@dataclass(frozen=True)
class Curve:
    """y'² = b₀ + b₁ y + … + b₄ y⁴ from y = 0 with y' = v."""

    v: Fraction
    b: tuple[Fraction, Fraction, Fraction, Fraction, Fraction]

    @classmethod
    def through(
        cls, alpha: Fraction, potential: Sequence[Fraction], p: Fraction, q: Fraction
    ) -> "Curve":
        c = [*potential, *[Fraction(0)] * (5 - len(potential))]
        powers = [q**k for k in range(5)]
        derivatives = (
            c[1] + 2 * c[2] * q + 3 * c[3] * powers[2] + 4 * c[4] * powers[3],
            c[2] + 3 * c[3] * q + 6 * c[4] * powers[2],
            c[3] + 4 * c[4] * q,
            c[4],
        )
        b1, b2, b3, b4 = (-2 * alpha * x for x in derivatives)
        return cls(alpha * p, (alpha**2 * p**2, b1, b2, b3, b4))

    @property
    def degree(self) -> int:
        return next((k for k in (4, 3, 2, 1) if self.b[k]), 0)

    @cached_property
    def invariants(self) -> tuple[Fraction, Fraction]:
        """g₂ and g₃."""
        b0, b1, b2, b3, b4 = self.b
        g2 = b4 * b0 - b3 * b1 / 4 + b2**2 / 12
        g3 = b4 * b2 * b0 / 6 + b3 * b2 * b1 / 48 - b2**3 / 216 - b4 * b1**2 / 16 - b3**2 * b0 / 16
        return g2, g3

    @cached_property
    def delta(self) -> Fraction:
        g2, g3 = self.invariants
        return g2**3 - 27 * g3**2

    @property
    def lost(self) -> int:
        """Digits by which 1 and the modulus may agree, as they do near a separatrix."""
        if isinstance(self.v, Batch):
            return 0  # floats have the digits that they have
        g2, g3 = self.invariants
        if not self.delta:
            return 0
        ratio = (abs(g2) ** 3 + 27 * g3**2) / abs(self.delta)
        return (ratio.numerator.bit_length() - ratio.denominator.bit_length() + 1) * 3 // 10

    def function(self, mp: Context) -> Weierstrass:
        return Weierstrass(mp, *(number(mp, x) for x in (*self.invariants, self.delta)))

    def at(self, mp: Context, t: Number) -> tuple[Number, Number]:
        """y and y' at time t."""
        b0, b1, b2, b3, b4 = (number(mp, x) for x in self.b)
        v = number(mp, self.v)
        g2, _ = self.invariants
        if self.degree <= 2:
            return self.linear(mp, t)
        double = self.between_saddles
        if double is not None:
            return self.heteroclinic(mp, t, double)
        found = self.function(mp).values(t)
        if found is None:
            return mp.mpf(0), v
        return biermann(v, (b0, b1, b2, b3, b4), number(mp, g2), found)

    def linear(self, mp: Context, t: Number) -> tuple[Number, Number]:
        """The solution of y'' = b₁/2 + b₂ y."""
        v, b1, b2 = (number(mp, x) for x in (self.v, self.b[1], self.b[2]))
        if self.b[2] > 0 and self.b[1] ** 2 == 4 * self.b[0] * self.b[2]:
            # On a line through the saddle one exponential is all there is, and the other is noise.
            rate = mp.sqrt(b2) if self.v * self.b[1] > 0 else -mp.sqrt(b2)
            gone = mp.exp(rate * t)
            return b1 / (2 * b2) * (gone - 1), v * gone
        (c, s), (_, half) = waves(mp, b2, t), waves(mp, b2, t / 2)
        return v * s + b1 * half**2, v * c + b1 * s / 2

    @property
    def between_saddles(self) -> Fraction | None:
        """The double root d > 0 of 4w³ − g₂w − g₃, where A and B both vanish at ℘ = d."""
        g2, g3 = self.invariants
        if self.delta or g2 * g3 >= 0:
            return None
        b0, b1, b2, b3, b4 = self.b
        apart = -3 * g3 / (2 * g2) - b2 / 12
        vanish = b1 * apart / 2 + b0 * b3 / 4, 2 * apart**2 - b0 * b4 / 2
        return None if any(vanish) else -3 * g3 / (2 * g2)

    def heteroclinic(self, mp: Context, t: Number, double: Fraction) -> tuple[Number, Number]:
        """A/B divided by ε = ℘ − d, which becomes exponentially small; ℘'/ε = −2κ coth κt."""
        square, apart = number(mp, 3 * double), number(mp, double - self.b[2] / 12)
        v, b1 = number(mp, self.v), number(mp, self.b[1])
        c, s = waves(mp, square, t)
        if s == 0:
            return mp.mpf(0), v
        small, ratio = 1 / s**2, -2 * c / s
        above, below = b1 / 2 - v * ratio, 2 * small + 4 * apart
        d_above, d_below = -2 * v * small, 2 * small * ratio
        return above / below, (d_above * below - above * d_below) / below**2

    # -- where the motion goes --------------------------------------------------------------------

    def destination(self, sign: int) -> int:
        """1 or −1 where y goes to ±∞, forwards or backwards in time; 0 where it stays bounded.

        At a simple root of f the motion turns; a multiple one it never reaches.
        """
        towards = 1 if (sign * self.v or self.b[1]) > 0 else -1
        kept = self.b if self.v else self.b[1:]  # y = 0 is a root: the motion turns there
        # Mirrored so that the motion goes to the right.
        powers = [
            sympy.Rational(x.numerator, x.denominator) * towards**k for k, x in enumerate(kept)
        ]
        f = sympy.Poly(powers[::-1], sympy.Symbol("y"))
        if f.degree() < 1 or f.count_roots(inf=0) == 0:
            return towards
        if self.v == 0 or f.count_roots(sup=0) or _nearest_is_multiple(f):
            return 0
        return -towards

    def time_to_infinity(self, mp: Context, sign: int, end: int) -> Number:
        """|t| at which y is infinite, forwards or backwards in time, at the end ±∞."""
        _, b1, b2, b3, b4 = (number(mp, x) for x in self.b)
        v, root = sign * number(mp, self.v), end * mp.sqrt(b4)
        value, slope = b2 / 12 + v * root / 2, -(b3 * v + b1 * root) / 4
        return self.function(mp).inverse(value, slope)


def _nearest_is_multiple(f: sympy.Poly) -> bool:
    """Whether the least of the positive roots of f, which has some, and not 0, is multiple.

    By counting roots (Sturm) rather than finding them: numbers of any size take no longer.
    """
    multiple = f.gcd(f.diff()).sqf_part()
    if multiple.degree() != 1:
        return bool(multiple.degree() == 2)  # then f is a square
    lead, rest = multiple.all_coeffs()
    root = -rest / lead
    while f.rem(multiple).is_zero:
        f = f.quo(multiple)
    return bool(root > 0 and (f.degree() < 1 or f.count_roots(inf=0, sup=root) == 0))


def biermann(
    v: Number,
    b: tuple[Number, Number, Number, Number, Number],
    g2: Number,
    function: tuple[Number, Number],
) -> tuple[Number, Number]:
    """y and y' from the values of ℘ and ℘'; see the module's formula. ℘'' = 6℘² − g₂/2."""
    b0, b1, b2, b3, b4 = b
    w, slope = function
    bend = 6 * w**2 - g2 / 2
    x = w - b2 / 12
    above = -v * slope + b1 * x / 2 + b0 * b3 / 4
    below = 2 * x**2 - b0 * b4 / 2
    d_above = -v * bend + b1 * slope / 2
    d_below = 4 * x * slope
    return above / below, (d_above * below - above * d_below) / below**2
