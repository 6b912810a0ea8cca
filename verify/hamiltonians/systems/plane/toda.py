"""The periodic Toda lattice of two particles, relative to each other: V = e^q + e^(−q).

With ξ = e^(q − q₀) and g = e^(q₀), ξ'² = 2E ξ² − 2g ξ³ − 2ξ/g is a cubic, and the formula for
polynomial potentials applies. The invariants, which do not depend on g, are g₂ = E²/3 − 1 and
g₃ = E/6 − E³/27, whose roots are e₁ = E/6 and −E/12 ± √(E² − 4)/4 with
E − 2 = p²/2 + 4 sinh²(q/2).
"""

from fractions import Fraction

from flint import arb

from verify.hamiltonians.elliptic import Weierstrass
from verify.hamiltonians.named_system import Motion, State, System, Values, at_rest, exactly
from verify.hamiltonians.potential_motion import biermann


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    v, start = exactly(p), exactly(q)

    def state(t: arb) -> State:
        # E − 2 is computed without cancellation near the equilibrium, as a sum of squares.
        above = v**2 / 2 + 4 * (arb(start) / 2).sinh() ** 2
        energy, g = 2 + above, arb(start).exp()
        part = (above * (energy + 2)).sqrt() / 4
        function_values = Weierstrass(energy / 6, (part - energy / 12, -part - energy / 12)).values(
            t
        )
        b = (v**2, 2 * v**2 - 2 * g + 2 / g, v**2 - 4 * g + 2 / g, -2 * g, arb(0))
        y, slope = biermann(v, b, energy**2 / 3 - 1, function_values)
        return slope / (1 + y), start + (1 + y).log()

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
