"""The periodic Toda lattice of two particles, relative to each other: V = e^q + e^(−q).

With ξ = e^(q − q₀) and g = e^(q₀), ξ'² = 2E ξ² − 2g ξ³ − 2ξ/g is a cubic, and the formula for
polynomial potentials applies. The invariants, which do not depend on g, are g₂ = E²/3 − 1 and
g₃ = E/6 − E³/27, so that Δ = (E² − 4)/4 with E − 2 = p²/2 + 4 sinh²(q/2).
"""

from fractions import Fraction

from verify.hamiltonians.motion import Context, Motion, Number, State, Values, at_rest, number
from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import biermann
from verify.hamiltonians.weierstrass import Weierstrass


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    def state(mp: Context, t: Number) -> State:
        v, start = number(mp, p), number(mp, q)
        above = v**2 / 2 + 4 * mp.sinh(start / 2) ** 2
        energy, g = 2 + above, mp.exp(start)
        g2, g3 = energy**2 / 3 - 1, energy / 6 - energy**3 / 27
        found = Weierstrass(mp, g2, g3, above * (energy + 2) / 4).values(t)
        if found is None:
            return v, start
        b = (v**2, 2 * v**2 - 2 * g + 2 / g, v**2 - 4 * g + 2 / g, -2 * g, mp.mpf(0))
        y, slope = biermann(v, b, g2, found)
        if y <= -1:
            raise ValueError("too few digits")  # ξ > 0
        return slope / (1 + y), start + mp.log(1 + y)

    if p == q == 0:
        return at_rest(p, q)
    return Motion(state, "closed form: Weierstrass's ℘ by Jacobi's elliptic functions")


SYSTEM = System(
    name="toda",
    title="periodic Toda lattice of two particles",
    formula="p**2/2 + exp(q) + exp(-q)",
    source="M. Toda, Theory of Nonlinear Lattices, 1981",
    flow=_motion,
    regimes={
        "oscillation": {"p": "1/3", "q": "-3/2"},
        "wide": {"p": "0", "q": "8"},
        "small": {"p": "0", "q": "1e-9"},
        "rest": {"p": "0", "q": "0"},
    },
)
