"""Weierstrass's ℘ on the real axis, by Jacobi's functions, for any real invariants.

℘'² = 4℘³ − g₂℘ − g₃ = 4 (℘ − e₁)(℘ − e₂)(℘ − e₃) with Δ = g₂³ − 27g₃² (Abramowitz and Stegun,
18.9; DLMF 23.6). Δ is an argument of its own, as it decides near a separatrix, and cancels there:
who has exact invariants gives it exactly. From the root r that is alone, which exists unless all
are 0, the other two follow by Δ without loss: their difference squared is Δ / (16 (3r² − g₂/4)²).
"""

from dataclasses import dataclass

from verify.arithmetic.batch import choose, some
from verify.hamiltonians.motion import Context, Number


@dataclass(frozen=True)
class Weierstrass:
    """℘ with g₂, g₃ and Δ in a context."""

    mp: Context
    g2: Number
    g3: Number
    delta: Number

    def values(self, t: Number) -> tuple[Number, Number] | None:
        """℘(t) and ℘'(t) for real t; None at a pole."""
        if self.delta == 0:
            return self._elementary(t)
        if self.delta > 0:
            return self._three_real_roots(t)
        return self._one_real_root(t)

    def half_period(self) -> Number:
        """Half of the real period, infinite where there is none."""
        if self.delta == 0 and self._double >= 0:
            return self.mp.inf
        roots = self._roots()
        return self._inverse(roots[0], roots)

    def inverse(self, value: Number, slope: Number) -> Number:
        """The least t > 0 with ℘(t) = value (on the real branch) and ℘'(t) of that sign."""
        t = self._inverse(value, self._roots())
        return t if slope <= 0 else 2 * self.half_period() - t

    # -- by the sign of Δ -------------------------------------------------------------------------

    @property
    def _double(self) -> Number:
        """The double root, where Δ = 0."""
        return -3 * self.g3 / (2 * self.g2) if self.g2 else self.g2

    def _elementary(self, t: Number) -> tuple[Number, Number] | None:
        mp, d = self.mp, self._double
        if t == 0:
            return None
        c, s = waves(mp, 3 * d, t)
        return d + 1 / s**2, -2 * c / s**3

    def _three_real_roots(self, t: Number) -> tuple[Number, Number] | None:
        mp = self.mp
        e1, e2, e3 = self._roots()
        k = mp.sqrt(e1 - e3)
        sn, cn, dn = jacobi(mp, k * t, (e2 - e3) / (e1 - e3))
        if sn == 0:
            return None
        return e3 + (k / sn) ** 2, -2 * (k / sn) ** 3 * cn * dn

    def _one_real_root(self, t: Number) -> tuple[Number, Number] | None:
        mp = self.mp
        r = self._alone()
        size = mp.sqrt(3 * r**2 - self.g2 / 4)
        k = mp.sqrt(size)
        sn, cn, dn = jacobi(mp, 2 * k * t, mp.mpf(1) / 2 - 3 * r / (4 * size))
        if sn == 0 and cn > 0:
            return None
        total = 1 + abs(cn)
        less = choose(cn > 0, sn**2 / total, total)  # 1 − cn, which cancels where cn > 0
        return r + size * (1 + cn) / less, -4 * k**3 * sn * dn / less**2

    def _alone(self) -> Number:
        """The real root of the greatest size; the only real one where Δ < 0."""
        mp, sign = self.mp, choose(self.g3 < 0, -1, 1)
        part = mp.sqrt(abs(self.delta) / 27)
        if self.delta >= 0:
            angle = mp.atan2(part, abs(self.g3))
            return sign * 2 * mp.sqrt(self.g2 / 12) * mp.cos(angle / 3)
        u = mp.cbrt((abs(self.g3) + part) / 8)
        return sign * (u + self.g2 / (12 * u))

    def _roots(self) -> tuple[Number, Number, Number]:
        """e₁ > e₂ > e₃, or the real one and the others where Δ < 0."""
        mp = self.mp
        r = self._alone()
        near = 3 * r**2 - self.g2 / 4
        apart = mp.sqrt(mp.mpc(self.delta)) / (4 * near) if near else mp.mpf(0)
        if self.delta < 0:
            return r, -r / 2 + apart / 2, -r / 2 - apart / 2
        half = abs(apart) / 2
        others = -r / 2 + half, -r / 2 - half
        above = r > 0
        return (
            choose(above, r, others[0]),
            choose(above, others[0], others[1]),
            choose(above, others[1], r),
        )

    def _inverse(self, value: Number, roots: tuple[Number, Number, Number]) -> Number:
        """The t in 0 … half a period with ℘(t) = value."""
        return self.mp.re(self.mp.elliprf(*(value - e for e in roots)))


def jacobi(mp: Context, u: Number, m: Number) -> tuple[Number, Number, Number]:
    """sn, cn and dn of real u with the parameter m ≥ 0; beyond 1 by Jacobi's transformation.

    By the arithmetic-geometric mean (Abramowitz and Stegun, 16.4): mpmath's own, by theta series,
    are slower, and very much so where m is near 1. Raises ValueError where u has no digit.
    """
    if mp.mag(u) > mp.prec:
        raise ValueError("too few digits")
    if m > 1:
        k = mp.sqrt(m)
        sn, cn, dn = jacobi(mp, k * u, 1 / m)
        return sn / k, dn, cn
    if m == 1:
        return mp.tanh(u), mp.sech(u), mp.sech(u)
    a, b, c = mp.mpf(1), mp.sqrt(1 - m), mp.sqrt(m)
    ratios = []
    while some(c > mp.eps * a):  # a turn too many changes nothing
        a, b, c = (a + b) / 2, mp.sqrt(a * b), (a - b) / 2
        ratios.append(c / a)
    angle = mp.ldexp(a * u, len(ratios))
    for ratio in reversed(ratios):
        angle = (angle + mp.asin(ratio * mp.sin(angle))) / 2
    cn, sn = mp.cos_sin(angle)
    return sn, cn, mp.sqrt(1 - m + m * cn**2)


def waves(mp: Context, square: Number, t: Number) -> tuple[Number, Number]:
    """cosh κt and sinh(κt)/κ for real κ² of any sign. Raises ValueError where κt has no digit."""
    if square == 0:
        return mp.mpf(1), t
    k = mp.sqrt(abs(square))
    if mp.mag(k * t) > mp.prec:
        raise ValueError("too few digits")
    if square < 0:
        return mp.cos(k * t), mp.sin(k * t) / k
    return mp.cosh(k * t), mp.sinh(k * t) / k
