"""The harmonic oscillator q'' + ω² q = 0, on which det J is constant."""

from fractions import Fraction

from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

SYSTEM = System(
    name="harmonic",
    title="harmonic oscillator",
    formula="p**2/2 + omega**2*q**2/2",
    source="p'' = −ω² p",
    parameters={"omega": "angular frequency"},
    flow=in_potential(lambda v: (Fraction(0), Fraction(0), v["omega"] ** 2 / 2)),
    regimes={
        "oscillation": {"omega": "3", "p": "1", "q": "-2/7"},
        "rest": {"omega": "3", "p": "0", "q": "0"},
        "no-force": {"omega": "0", "p": "1/3", "q": "2"},
    },
)
