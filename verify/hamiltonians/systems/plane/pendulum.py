"""The mathematical pendulum q'' + sin q = 0 (Eq. 25).

s = sin q/2, c = cos q/2 and d = p/2 obey s' = cd, c' = −sd, d' = −sc, Euler's equations, whose
solution through s = 0 is by sn, cn and dn with the parameter m = s² + d². The addition theorem
(DLMF 22.8) takes it from any initial value, with m < 1 for libration and m > 1 for rotation alike:

    s(t) = (s cn dn + c d sn)/N,  c(t) = (c dn − s d sn cn)/N,  d(t) = (d cn − s c sn dn)/N,

N = 1 − s² sn². By Lindemann's theorem q = 0, p = ±2 is the one rational point on the separatrix.
"""

from fractions import Fraction

import flint

from verify.arithmetic.flint_precision import sign_of
from verify.hamiltonians.motion import Context, Motion, Number, State, Values, at_rest, number
from verify.hamiltonians.named_system import System
from verify.hamiltonians.weierstrass import jacobi


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    separatrix = q == 0 and abs(p) == 2

    def state(mp: Context, t: Number) -> State:
        start, d = number(mp, q), number(mp, p) / 2
        turns = mp.nint(start / (2 * mp.pi))
        s, c = mp.sin(start / 2 - turns * mp.pi), mp.cos(start / 2 - turns * mp.pi)
        m = s**2 + d**2
        if m == 1 and not separatrix:
            raise ValueError("too few digits")
        if m <= 1:
            s, c, d = _added(mp, s, c, d, t, m)
            return 2 * d, 2 * (mp.atan2(s, c) + turns * mp.pi)
        period = 2 * mp.ellipk(1 / m) / mp.sqrt(m)  # in which q goes on by 2π
        whole = mp.floor(t / period)
        rest = t - whole * period
        s1, c1, d1 = _added(mp, s, c, d, rest, m)
        sign = mp.sign(d)
        angle = sign * 2 * mp.atan2(s1 * c - c1 * s, c1 * c + s1 * s)  # gone on, up to 2π
        gone = angle - 2 * mp.pi * mp.floor(angle / (2 * mp.pi))
        near = mp.ldexp(1, -mp.prec // 3)
        if rest < period / 2 and gone > 2 * mp.pi - near:
            gone -= 2 * mp.pi
        elif rest > period / 2 and gone < near:
            gone += 2 * mp.pi
        return 2 * d1, start + sign * (gone + 2 * mp.pi * whole)

    if p == q == 0:
        return at_rest(p, q)
    if separatrix:
        return Motion(state, "closed form: elementary functions")
    return Motion(state, "closed form: Jacobi's elliptic functions", goes=lambda: _goes(p, q))


def _added(
    mp: Context, s: Number, c: Number, d: Number, t: Number, m: Number
) -> tuple[Number, Number, Number]:
    sn, cn, dn = jacobi(mp, t, m)
    n = 1 - (s * sn) ** 2
    return (
        (s * cn * dn + c * d * sn) / n,
        (c * dn - s * d * sn * cn) / n,
        (d * cn - s * c * sn * dn) / n,
    )


def _goes(p: Fraction, q: Fraction) -> str | None:
    """Whether it goes round: p²/2 − cos q > 1, where it is not 1."""
    height, angle = (flint.fmpq(x.numerator, x.denominator) for x in (p**2 / 2 - 1, q))
    if sign_of(lambda: height - flint.arb(angle).cos()) < 0:
        return None
    return f"q goes to {'+' if p > 0 else '−'}∞ as t grows: the pendulum goes round"


SYSTEM = System(
    name="pendulum",
    title="mathematical pendulum",
    formula="p**2/2 - cos(q)",
    source="Eq. 25–26",
    flow=_motion,
    regimes={
        "libration": {"p": "1/3", "q": "3/2"},
        "wide-libration": {"p": "0", "q": "31415926535/10000000000"},
        "libration-elsewhere": {"p": "-1/3", "q": "100"},
        "separatrix": {"p": "2", "q": "0"},
        "near-separatrix": {"p": "2.0000000000000000001", "q": "0"},
        "rotation": {"p": "5/2", "q": "1"},
        "rotation-backwards": {"p": "-3", "q": "-7/2"},
        "rest": {"p": "0", "q": "0"},
    },
)
