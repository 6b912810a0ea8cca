"""Motion in a polynomial potential of degree up to 4, in closed form from any initial value.

H = α p²/2 + V(q) gives q'² = f(q) with f = 2α (E − V), a polynomial of degree up to 4. With its
invariants g₂ and g₃ and ℘ = ℘(t; g₂, g₃), Biermann's and Weierstrass's formula (Whittaker and
Watson, A Course of Modern Analysis, 20.6) is, for f = Σ b_k y^k in y = q − q₀, and v = q'(0),

    q(t) = q₀ + A/B,  A = −v ℘' + (b₁/2)(℘ − b₂/12) + b₀b₃/4,  B = 2 (℘ − b₂/12)² − b₀b₄/2.

It holds in every regime, and has no branches. q is infinite if B = 0; then (x → ∞ in the formula's
inverse) ℘ = b₂/12 + s v √b₄/2 and ℘' = −(b₃ v + s b₁ √b₄)/4, with s the sign of q'. The b_k are
exact, so Δ = 0 (a separatrix, or elementary functions) is decided exactly.

B may vanish together with A at some real t, but not at a rational t ≠ 0: if Δ ≠ 0 and g₂, g₃ and
℘(t) are algebraic, t is transcendental (Schneider). So enough precision always yields A/B.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from flint import arb, fmpq, fmpq_poly

from verify.arithmetic.flint_precision import AtEachPrecision, working_precision
from verify.hamiltonians.elliptic import NOT_KNOWN, Real, Weierstrass, double_root, waves
from verify.hamiltonians.named_system import ClosedFormFlow, Motion, State, Values, at_rest, exactly

_METHOD = "closed form: Weierstrass's ℘ by Jacobi's elliptic functions"
_ELEMENTARY = "closed form: elementary functions"


def in_potential(coefficients: Callable[[Values], Sequence[Fraction]]) -> ClosedFormFlow:
    """Return the flow of p²/2 + Σ c_k q^k, k = 0 … 4; `coefficients`: parameters → the c_k."""

    def flow(values: Values, p: Fraction, q: Fraction) -> Motion:
        return motions(fmpq(1), [exactly(c) for c in coefficients(values)])(p, q)

    return flow


def motions(alpha: fmpq, potential: Sequence[fmpq]) -> Callable[[Fraction, Fraction], Motion]:
    """Return (p, q) ↦ the motion from (p, q) for H = α p²/2 + V(q), α ≠ 0, V of degree up to 4."""
    return partial(_motion, PotentialField.from_potential(alpha, potential))


def _motion(field: "PotentialField", p: Fraction, q: Fraction) -> Motion:
    curve = Curve.from_point(field, exactly(p), exactly(q))
    if curve.v == 0 and curve.b[1] == 0:
        return at_rest(p, q)
    ends = curve.degree > 2 and not curve.is_confined
    method = _METHOD if curve.delta else _ELEMENTARY
    return Motion(curve.state, method, curve.blow_up if ends else None, curve.goes)


@dataclass(frozen=True)
class PotentialField:
    """The equation q'² = a₀ + f(q), q' = α p, of all motions; only a₀ depends on the motion.

    The invariants of a₀ + f are g₂ = `g2[0]` + `g2[1]` a₀, and g₃ likewise.
    """

    alpha: fmpq
    f: fmpq_poly
    g2: tuple[fmpq, fmpq]
    g3: tuple[fmpq, fmpq]

    @classmethod
    def from_potential(cls, alpha: fmpq, potential: Sequence[fmpq]) -> "PotentialField":
        """Return the field for H = α p²/2 + V(q)."""
        f = fmpq_poly([0, *(-2 * alpha * c for c in potential[1:])])
        a1, a2, a3, a4 = (f[k] for k in range(1, 5))
        # The invariants of a quartic are affine in its constant term a₀.
        g2 = a2**2 / 12 - a3 * a1 / 4, a4
        g3 = a3 * a2 * a1 / 48 - a2**3 / 216 - a4 * a1**2 / 16, a4 * a2 / 6 - a3**2 / 16
        return cls(alpha, f, g2, g3)


@dataclass(slots=True, eq=False)
class Curve:
    """The solution y of y'² = b₀ + b₁ y + … + b₄ y⁴ from y = 0 with y' = v; q = `start` + y and
    q' = α p."""

    alpha: fmpq
    start: fmpq
    v: fmpq
    b: tuple[fmpq, fmpq, fmpq, fmpq, fmpq]
    degree: int
    invariants: tuple[fmpq, fmpq]  # g₂ and g₃
    delta: fmpq
    # Returns t ↦ (℘, ℘') at flint's precision; cached, since a motion is evaluated at many times.
    function: Callable[[], Callable[[Real], tuple[arb, arb]]]

    @classmethod
    def from_point(cls, field: PotentialField, p: fmpq, q: fmpq) -> "Curve":
        """Return the curve through (p, q)."""
        shifted, v = field.f(fmpq_poly([q, 1])), field.alpha * p
        b = v * v, shifted[1], shifted[2], shifted[3], shifted[4]
        # A shift of y does not change the invariants; those of f are computed with shorter numbers.
        a0 = b[0] - shifted[0]
        g2, g3 = (constant + a0 * more for constant, more in (field.g2, field.g3))
        invariants, delta = (g2, g3), g2**3 - 27 * g3**2
        function = AtEachPrecision(partial(_function, invariants, delta))
        return cls(field.alpha, q, v, b, max(shifted.degree(), 0), invariants, delta, function)

    @property
    def is_confined(self) -> bool:
        """True if V grows beyond all bounds on both sides, by its term of degree 4."""
        return bool(self.b[4] < 0)

    def state(self, t: arb) -> State:
        """Return p and q at time t."""
        y, slope = self.evaluate(t)
        return slope / self.alpha, self.start + y

    def evaluate(self, t: arb) -> tuple[arb, arb]:
        """Return y and y' at time t."""
        if self.degree <= 2:
            return self.linear(t)
        if self.delta:
            return biermann(self.v, self.b, self.invariants[0], self.function()(t))
        d = double_root(*self.invariants)
        if self._between_saddles(d):
            return self.heteroclinic(t, d)
        c, s = waves(3 * d, t)
        return biermann(self.v, self.b, self.invariants[0], (d + 1 / s**2, -2 * c / s**3))

    def linear(self, t: arb) -> tuple[arb, arb]:
        """Return the solution of y'' = b₁/2 + b₂ y."""
        b0, b1, b2, *_ = self.b
        if b2 > 0 and b1**2 == 4 * b0 * b2:
            # On a line through the saddle the solution has one exponential; the other one would be
            # rounding noise.
            rate = arb(b2).sqrt() if self.v * b1 > 0 else -arb(b2).sqrt()
            exponent = rate * t
            return b1 / (2 * b2) * exponent.expm1(), self.v * exponent.exp()
        (c, s), (_, half) = waves(b2, t), waves(b2, t / 2)
        return self.v * s + b1 * half**2, self.v * c + b1 * s / 2

    def _between_saddles(self, double: fmpq) -> bool:
        """Return True if A and B both vanish at the limit of ℘, the double root d > 0."""
        b0, b1, b2, b3, b4 = self.b
        difference = double - b2 / 12
        vanish = b1 * difference / 2 + b0 * b3 / 4, 2 * difference**2 - b0 * b4 / 2
        return bool(double > 0 and not any(vanish))

    def heteroclinic(self, t: arb, double: fmpq) -> tuple[arb, arb]:
        """Return y and y' from A/B, with A and B divided by ε = ℘ − d, which becomes exponentially
        small; ℘'/ε = −2κ coth κt."""
        c, s = waves(3 * double, t)
        small, ratio = 1 / s**2, -2 * c / s
        above = self.b[1] / 2 - self.v * ratio
        below = 2 * small + 4 * (double - self.b[2] / 12)
        d_above, d_below = -2 * self.v * small, 2 * small * ratio
        return above / below, (d_above * below - above * d_below) / below**2

    # -- where the motion goes --------------------------------------------------------------------

    def blow_up(self, sign: int) -> arb | None:
        """Return |t| of the blow-up (see `verify.hamiltonians.named_system.Motion`), for a curve of
        degree 3 or 4."""
        destination = self.destination(sign)
        return self.time_to_infinity(sign, destination) if destination else None

    def goes(self) -> str | None:
        """Return a text that says how the motion goes to infinity in infinite time; else None."""
        destination = 0 if self.degree > 2 else self.destination(1)
        return f"q goes to {'+' if destination > 0 else '−'}∞ as t grows" if destination else None

    def destination(self, sign: int) -> int:
        """Return 1 or −1 if y goes to ±∞, forwards or backwards in time (`sign`); 0 if it stays
        bounded.

        The motion turns at a simple root of the polynomial, and never reaches a multiple one.
        """
        if self.is_confined:
            return 0
        towards = 1 if (sign * self.v or self.b[1]) > 0 else -1
        coefficients = self.b if self.v else self.b[1:]  # y = 0 is a root: the motion turns there
        # The polynomial is mirrored so that the motion begins to the right.
        f = fmpq_poly([x * towards**k for k, x in enumerate(coefficients)])
        bits = 64
        # The loop ends: flint's roots have exact multiplicities, so some precision separates them
        # from 0 and from each other.
        while True:
            with working_precision(bits):
                root_pairs: Any = f.numer().complex_roots()
            roots = [(r.real, n) for r, n in root_pairs if r.imag == 0]
            ahead = [(x, n) for x, n in roots if x > 0]
            if len(ahead) == 0 and all(x < 0 for x, _ in roots):
                return towards
            # True or False for each root that may be the nearest: whether it is multiple.
            nearest = {n > 1 for x, n in ahead if not any(y < x for y, _ in ahead)}
            if len(nearest) == 1 and all(x > 0 or x < 0 for x, _ in roots):
                turns_back = self.v == 0 or len(ahead) < len(roots)
                return 0 if turns_back or nearest == {True} else -towards
            bits *= 2

    def time_to_infinity(self, sign: int, end: int) -> arb:
        """Return |t| at which y reaches ±∞ (`end`), forwards or backwards in time (`sign`)."""
        _, b1, b2, b3, b4 = self.b
        v, root = sign * self.v, end * arb(b4).sqrt()
        slope = -(b3 * v + b1 * root)
        # Compared exactly: ℘' = 0, which balls of no precision could decide.
        if (b3 * v) ** 2 == b1**2 * b4 and b3 * v * b1 * end <= 0:
            side = 0
        elif slope > 0 or slope < 0:
            side = 1 if slope > 0 else -1
        else:
            return NOT_KNOWN
        return Weierstrass.from_invariants(*self.invariants, self.delta).inverse(
            b2 / 12 + v * root / 2, side
        )


def _function(invariants: tuple[fmpq, fmpq], delta: fmpq) -> Callable[[Real], tuple[arb, arb]]:
    return Weierstrass.from_invariants(*invariants, delta).values


def biermann(
    v: Real, b: tuple[Real, Real, Real, Real, Real], g2: Real, function: tuple[Real, Real]
) -> tuple[arb, arb]:
    """Return y and y' from the values of ℘ and ℘', by the module's formula and ℘'' = 6℘² − g₂/2."""
    b0, b1, b2, b3, b4 = b
    w, slope = function
    speed, half = arb(v), arb(b1) / 2
    bend = 6 * w * w - g2 / 2
    x = w - b2 / 12
    above = half * x - speed * slope + b0 * b3 / 4
    below = 2 * x * x - b0 * b4 / 2
    y = above / below
    return y, (half * slope - speed * bend - 4 * y * x * slope) / below
