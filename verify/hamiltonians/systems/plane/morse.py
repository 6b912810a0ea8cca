"""The Morse oscillator, V = D (1 − e^(−aq))²: a molecule that dissociates at the energy D.

With ξ = e^(a(q − q₀)) and g = e^(−a q₀) the equation is linear: ξ'' = κ² ξ + 2a² D g with
κ² = 2a² (E − D) = a² p₀² + 2a² D (g² − 2g), so that with S = sinh(κt)/κ and C = cosh(κt)

    ξ(t) = C + a p₀ S + 4a² D g S(t/2)².

κ² is rational only for q₀ = 0 (Lindemann), where it may be 0.
"""

from fractions import Fraction

import flint

from verify.arithmetic.flint_precision import sign_of
from verify.hamiltonians.motion import Context, Motion, Number, State, Values, at_rest, number
from verify.hamiltonians.named_system import System
from verify.hamiltonians.weierstrass import waves


def _motion(values: Values, p: Fraction, q: Fraction) -> Motion | None:
    depth, a = values["D"], values["a"]
    if depth <= 0 or a == 0:  # V is a barrier, from which orbits fall, or no potential at all
        return None

    def state(mp: Context, t: Number) -> State:
        rate, start, g = number(mp, a), number(mp, p), mp.exp(number(mp, -a * q))
        pull = 2 * rate**2 * number(mp, depth) * g
        square = (rate * start) ** 2 + pull * (g - 2)
        c, s = waves(mp, square, t)
        _, half = waves(mp, square, t / 2)
        xi = c + rate * start * s + 2 * pull * half**2
        slope = square * s + rate * start * c + pull * s
        if xi <= 0:
            raise ValueError("too few digits")  # ξ > 0
        return slope / (rate * xi), number(mp, q) + mp.log(xi) / rate

    if p == q == 0:
        return at_rest(p, q)
    return Motion(state, "closed form: elementary functions", goes=lambda: _goes(depth, a, p, q))


def _goes(depth: Fraction, a: Fraction, p: Fraction, q: Fraction) -> str | None:
    """Whether it dissociates: E − D = p²/2 + D (g² − 2g) ≥ 0."""
    kinetic, rate, size = (
        flint.fmpq(x.numerator, x.denominator) for x in (p**2 / 2, -a * q, depth)
    )

    def above() -> flint.arb:
        g = flint.arb(rate).exp()
        return kinetic + size * g * (g - 2)

    if (p**2 / 2 < depth) if q == 0 else (sign_of(above) < 0):
        return None
    return f"q goes to {'+' if a > 0 else '−'}∞ as t grows: the energy is not below D"


SYSTEM = System(
    name="morse",
    title="Morse oscillator",
    formula="p**2/2 + D*(1 - exp(-a*q))**2",
    source="P. M. Morse, Phys. Rev. 34, 1929",
    parameters={"D": "depth of the well", "a": "its inverse width"},
    flow=_motion,
    regimes={
        "bound": {"D": "2", "a": "3/2", "p": "1/3", "q": "-1/4"},
        "threshold": {"D": "2", "a": "3/2", "p": "2", "q": "0"},
        "near-threshold": {"D": "2", "a": "1", "p": "1.9999999999999999999", "q": "0"},
        "free": {"D": "2", "a": "-1/2", "p": "3", "q": "1"},
        "rest": {"D": "2", "a": "1", "p": "0", "q": "0"},
    },
)
