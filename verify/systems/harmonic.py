"""The harmonic oscillator q'' + ω² q = 0, on which det J is constant."""

from verify.system import System

SYSTEM = System(
    name="harmonic",
    title="harmonic oscillator",
    formula="p**2/2 + omega**2*q**2/2",
    source="p'' = −ω² p",
    parameters={"omega": "angular frequency"},
)
