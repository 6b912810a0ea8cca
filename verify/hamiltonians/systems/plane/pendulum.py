"""The mathematical pendulum q'' + sin q = 0 (Eq. 25).

s = sin q/2, c = cos q/2 and d = p/2 obey s' = cd, c' = −sd, d' = −sc, Euler's equations, whose
solution through s = 0 is by sn, cn and dn with the parameter m = s² + d². The addition theorem
(DLMF 22.8) takes it from any initial value, with m < 1 for libration and m > 1 for rotation alike:

    s(t) = (s cn dn + c d sn)/N,  c(t) = (c dn − s d sn cn)/N,  d(t) = (d cn − s c sn dn)/N,

N = 1 − s² sn². By Lindemann's theorem q = 0, p = ±2 is the one rational point on the separatrix.
"""

from fractions import Fraction

from flint import arb

from verify.arithmetic.flint_precision import AtEachPrecision, sign_of
from verify.hamiltonians.elliptic import NOT_KNOWN, Functions, Real, jacobi, quarter_period
from verify.hamiltonians.named_system import Motion, State, System, Values, at_rest, exactly


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    separatrix = q == 0 and abs(p) == 2
    start, d = exactly(q), exactly(p) / 2

    @AtEachPrecision
    def begun() -> tuple[arb, arb, arb, arb, Functions]:
        turns = (start / (2 * arb.pi()) + 0.5).mid().floor()
        s, c = (start / 2 - turns * arb.pi()).sin_cos()
        m = arb(1) if separatrix else s**2 + d**2
        return turns, s, c, m, jacobi(m)

    def state(t: arb) -> State:
        turns, s, c, m, functions = begun()
        s1, c1, d1 = _addition_theorem(s, c, d, functions(t))
        if separatrix or m < 1:
            # s and c tell the angle between −π and π, where it stays; c > 0 tells that it is there.
            return 2 * d1, 2 * ((s1 / c1).atan() + turns * arb.pi() if c > 0 else NOT_KNOWN)
        if not m > 1:
            return NOT_KNOWN, NOT_KNOWN
        # q/2 goes on as the amplitude, which is π/2 at most beside its even rate (DLMF 22.16), so
        # that two such differ by less than π.
        root = m.sqrt()
        even = (1 if d > 0 else -1) * arb.pi() * root * t / (2 * quarter_period(1 / m))
        x, y = c1 * c + s1 * s, s1 * c - c1 * s
        sin, cos = even.sin_cos()
        return 2 * d1, start + 2 * (even + arb.atan2(y * cos - x * sin, x * cos + y * sin))

    if p == q == 0:
        return at_rest(p, q)
    if separatrix:
        return Motion(state, "closed form: elementary functions")
    return Motion(state, "closed form: Jacobi's elliptic functions", goes=lambda: _goes(p, q))


def _addition_theorem(
    s: arb, c: arb, d: Real, functions: tuple[arb, arb, arb]
) -> tuple[arb, arb, arb]:
    """Return s, c and d at time t by the addition theorem in the module's text."""
    sn, cn, dn = functions
    n = 1 - (s * sn) ** 2
    return (
        (s * cn * dn + c * d * sn) / n,
        (c * dn - s * d * sn * cn) / n,
        (d * cn - s * c * sn * dn) / n,
    )


def _goes(p: Fraction, q: Fraction) -> str | None:
    """Return how the pendulum goes round: p²/2 − cos q > 1, where it is not 1."""
    height, angle = exactly(p**2 / 2 - 1), exactly(q)
    if sign_of(lambda: height - arb(angle).cos()) < 0:
        return None
    return f"q goes to {'+' if p > 0 else '−'}∞ as t grows: the pendulum goes round"


SYSTEM = System(
    name="pendulum",
    title="mathematical pendulum",
    formula="p**2/2 - cos(q)",
    source="A New Area-Preserving Geometric Numerical Algorithm of Nonlinear Systems, Eq. 25–26",
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
