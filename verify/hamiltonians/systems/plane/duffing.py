"""The Duffing oscillator q'' + q + δ q³ = 0 (Eq. 17), hard for δ > 0 and soft for δ < 0."""

from fractions import Fraction

from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

SYSTEM = System(
    name="duffing",
    title="Duffing oscillator",
    formula="p**2/2 + q**2/2 + delta*q**4/4",
    source="A New Area-Preserving Geometric Numerical Algorithm of Nonlinear Systems, Eq. 17–18",
    parameters={"delta": "coefficient of the cubic restoring force"},
    flow=in_potential(
        lambda v: (Fraction(0), Fraction(0), Fraction(1, 2), Fraction(0), v["delta"] / 4)
    ),
    regimes={
        "hard": {"delta": "1", "p": "1/3", "q": "3/2"},
        "linear": {"delta": "0", "p": "1/3", "q": "3/2"},
        "soft-inside": {"delta": "-1", "p": "1/10", "q": "1/2"},
        "soft-separatrix": {"delta": "-2", "p": "1/2", "q": "0"},
        "soft-near-separatrix": {"delta": "-2", "p": "0.50000000000000000001", "q": "0"},
        "soft-separatrix-outside": {"delta": "-2", "p": "-7/2", "q": "2"},
        "soft-outside": {"delta": "-1", "p": "-1/3", "q": "3/2"},
        "soft-over-the-barrier": {"delta": "-1", "p": "2", "q": "-3/2"},
        "soft-saddle": {"delta": "-4", "p": "0", "q": "1/2"},
    },
)
