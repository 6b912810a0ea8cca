"""The Morse oscillator, V = D (1 − e^(−aq))²: a molecule that dissociates at the energy D.

With ξ = e^(a(q − q₀)) and g = e^(−a q₀) the equation is linear: ξ'' = κ² ξ + 2a² D g with
κ² = 2a² (E − D) = a² p₀² + 2a² D (g² − 2g), so that with S = sinh(κt)/κ and C = cosh(κt)

    ξ(t) = C + a p₀ S + 4a² D g S(t/2)².

κ² is rational only for q₀ = 0 (Lindemann), where it may be 0.
"""

from fractions import Fraction

from flint import arb, fmpq

from verify.arithmetic.flint_precision import sign_of
from verify.hamiltonians.elliptic import waves
from verify.hamiltonians.named_system import Motion, State, System, Values, at_rest, exactly


def _motion(values: Values, p: Fraction, q: Fraction) -> Motion | None:
    depth, a = values["D"], values["a"]
    if depth <= 0 or a == 0:  # V is a barrier, from which orbits fall, or no potential at all
        return None

    if p == q == 0:
        return at_rest(p, q)
    rate, start, well = exactly(a), exactly(p), exactly(depth)

    def growth() -> arb | fmpq:
        return arb(exactly(-a * q)).exp() if q else fmpq(1)

    def state(t: arb) -> State:
        g = growth()
        pull = 2 * rate**2 * well * g
        square = (rate * start) ** 2 + pull * (g - 2)
        c, s = waves(square, t)
        _, half = waves(square, t / 2)
        xi = c + rate * start * s + 2 * pull * half**2
        slope = square * s + rate * start * c + pull * s
        return slope / (rate * xi), exactly(q) + xi.log() / rate

    def above() -> arb:
        g = arb(growth())
        return start**2 / 2 + well * g * (g - 2)

    def goes() -> str | None:
        """Return how the molecule dissociates: E − D = p²/2 + D (g² − 2g) ≥ 0."""
        # At q = 0 the sign is decided exactly; elsewhere E = D is impossible for rational p and q ≠
        # 0.
        if (p**2 / 2 < depth) if q == 0 else (sign_of(above) < 0):
            return None
        return f"q goes to {'+' if a > 0 else '−'}∞ as t grows: the energy is not below D"

    return Motion(state, "closed form: elementary functions", goes=goes)


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
