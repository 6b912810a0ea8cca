"""Jacobi's and Weierstrass's functions on the real axis, in balls, by flint's theta functions.

A result contains the true value. It is not finite if flint's precision is too low for the argument
or the modulus: the caller then raises the precision. Everything that does not depend on the
argument is computed once, at the precision at which the function is built.

With z = u/2K, τ = iK′/K and θ_k = θ_k(z, τ) (DLMF 22.2, and 20.9 for the values at z = 0)

    sn = m^(−1/4) θ₁/θ₄,  cn = ((1 − m)/m)^(1/4) θ₂/θ₄,  dn = (1 − m)^(1/4) θ₃/θ₄.

℘'² = 4℘³ − g₂℘ − g₃ = 4 (℘ − e₁)(℘ − e₂)(℘ − e₃) with Δ = g₂³ − 27g₃² (Abramowitz and Stegun, 18.9;
DLMF 23.6). flint's ℘ is not used: it needs the ratio of both periods, which are two integrals R_F
of Carlson; sn needs two arithmetic-geometric means.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from flint import acb, arb, fmpq

Real = arb | fmpq  # a ball, or an exact number in its place
Functions = Callable[[Real], tuple[arb, arb, arb]]  # u ↦ (sn, cn, dn)
NOT_KNOWN = arb.nan()


def jacobi(m: Real) -> Functions:
    """Return u ↦ (sn, cn, dn) for real u and the parameter m > 0; for m > 1 by the reciprocal
    modulus.

    >>> sn, cn, dn = jacobi(arb(1) / 2)(arb(1))
    >>> (sn**2 + cn**2).overlaps(arb(1)), (dn**2 + sn**2 / 2).overlaps(arb(1))
    (True, True)
    """
    # m = 1 is the limit of both cases (DLMF 22.5); K is infinite, and there are no theta functions.
    if m == 1:
        return lambda u: (arb(u).tanh(), arb(u).sech(), arb(u).sech())
    if m > 1:
        return _beyond_one(m)
    if not 0 < m < 1:
        return lambda _: (NOT_KNOWN, NOT_KNOWN, NOT_KNOWN)
    period = quarter_period(m)
    tau = acb(0, quarter_period(1 - m) / period)
    return partial(_by_theta, 2 * period, tau, arb(m).root(4), arb(1 - m).root(4))


def _by_theta(turn: arb, tau: acb, modulus: arb, complement: arb, u: Real) -> tuple[arb, arb, arb]:
    one, two, three, four = acb(u / turn).modular_theta(tau, 0)
    below = four.real
    sn_below = modulus * below
    return one.real / sn_below, complement * two.real / sn_below, complement * three.real / below


def _beyond_one(m: Real) -> Functions:
    """Return the functions for m > 1 from those for 1/m (DLMF 22.17: the reciprocal modulus)."""
    k, inside = arb(m).sqrt(), jacobi(1 / m)

    def functions(u: Real) -> tuple[arb, arb, arb]:
        sn, cn, dn = inside(k * u)
        return sn / k, dn, cn

    return functions


def quarter_period(m: Real) -> arb:
    """Return K(m) = π/(2 M(1, √(1 − m))) for real m < 1, by the arithmetic-geometric mean M (DLMF
    19.8.5)."""
    return arb.pi() / (2 * arb(1 - m).sqrt().agm())


@dataclass(frozen=True)
class Weierstrass:
    """The function ℘, given by its roots.

    `first`: the greatest real root e₁. `others`: e₂ ≥ e₃, or one of a pair of conjugate roots.
    """

    first: Real
    others: tuple[Real, Real] | acb

    @classmethod
    def from_invariants(cls, g2: fmpq, g3: fmpq, delta: fmpq) -> "Weierstrass":
        """Return ℘ for exact invariants; the sign of Δ tells whether all roots are real."""
        if delta == 0:
            d = double_root(g2, g3)
            return cls(d, (d, -2 * d)) if d >= 0 else cls(-2 * d, (d, d))
        # Cardano's formulas for 4x³ − g₂x − g₃: trigonometric for three real roots, else by a cube
        # root. The root r of the largest size is computed first, so that no sum cancels.
        sign, size, square = (-1 if g3 < 0 else 1), arb(abs(g3)), arb(g2) / 12
        discriminant_root = arb(abs(delta)).sqrt()
        part = discriminant_root / arb(27).sqrt()
        if delta > 0:
            r = 2 * sign * square.sqrt() * (arb.atan2(part, size) / 3).cos()
        else:
            u = ((size + part) / 8).root(3)
            r = sign * (u + square / u)
        # The two others differ by √Δ / (4 (3r² − g₂/4)), which loses no digits if they are close.
        half = discriminant_root / (24 * (r * r - square))
        if delta < 0:
            return cls(r, acb(-r / 2, half))
        above, below = -r / 2 + half, -r / 2 - half
        return cls(r, (above, below)) if sign > 0 else cls(above, (below, r))

    @property
    def values(self) -> Callable[[Real], tuple[arb, arb]]:
        """The function t ↦ (℘(t), ℘'(t)) for real t; all roots must be distinct."""
        e1, others = self.first, self.others
        if isinstance(others, acb):
            size = abs(e1 - others)
            functions = jacobi(fmpq(1, 2) - 3 * e1 / (4 * size))
            return partial(_by_a_pair, e1, size, size.sqrt(), functions)
        e2, e3 = others
        difference = e1 - e3
        return partial(_by_three, e3, arb(difference).sqrt(), jacobi((e2 - e3) / difference))

    def half_period(self) -> arb:
        """Return half of the real period, which is infinite if e₁ = e₂."""
        return carlson(arb(0), *(self.first - e for e in self._others()))

    def inverse(self, value: Real, side: int) -> arb:
        """Return the least t > 0 with ℘(t) = value ≥ e₁ at which ℘'(t) has the sign `side`, 1, −1
        or 0."""
        if side == 0:
            return self.half_period()
        # t = ∫ dx/√(4(x − e₁)(x − e₂)(x − e₃)) from value to ∞ is R_F of the differences (DLMF
        # 19.25.35).
        t = carlson(value - self.first, *(value - e for e in self._others()))
        return t if side < 0 else 2 * self.half_period() - t

    def _others(self) -> tuple[Real, Real] | tuple[acb, acb]:
        pair = self.others
        return (pair, pair.conjugate()) if isinstance(pair, acb) else pair


def _by_three(e3: Real, k: arb, functions: Functions, t: Real) -> tuple[arb, arb]:
    """Return ℘ and ℘' at t for three real roots; k² = e₁ − e₃."""
    sn, cn, dn = functions(k * t)
    pole = k / sn
    return e3 + pole * pole, -2 * pole * pole * pole * cn * dn


def _by_a_pair(e1: Real, size: arb, k: arb, functions: Functions, t: Real) -> tuple[arb, arb]:
    """Return ℘ and ℘' at t for a real root and a conjugate pair; k² = `size` = |e₁ − e₂|."""
    sn, cn, dn = functions(2 * k * t)
    less = 1 - cn
    return e1 + size * (1 + cn) / less, -4 * k * size * sn * dn / (less * less)


def double_root(g2: fmpq, g3: fmpq) -> fmpq:
    """Return the double root, for Δ = 0."""
    return -3 * g3 / (2 * g2) if g2 else fmpq(0)


def carlson(x: Real, y: Real | acb, z: Real | acb) -> arb:
    """Return Carlson's R_F of numbers ≥ 0, or of x ≥ 0 and a conjugate pair; not finite if x ≥ 0 is
    not certain."""
    if not x >= 0:
        return NOT_KNOWN
    return acb.elliptic_rf(*(v if isinstance(v, acb) else acb(v) for v in (x, y, z))).real


def waves(square: Real, t: Real) -> tuple[arb, arb]:
    """Return cosh κt and sinh(κt)/κ for real κ² = `square` of any sign, and for an exact 0; not
    finite if the sign is not certain."""
    if square == 0:
        return arb(1), arb(t)
    if square > 0:
        k = arb(square).sqrt()
        s, c = (k * t).sinh_cosh()
        return c, s / k
    if square < 0:
        k = arb(-square).sqrt()
        s, c = (k * t).sin_cos()
        return c, s / k
    return NOT_KNOWN, NOT_KNOWN
