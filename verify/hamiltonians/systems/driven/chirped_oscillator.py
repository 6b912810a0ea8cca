"""The harmonic oscillator with a force whose frequency rises, q'' + ω₀² q = γ sin(at + bt²)."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="chirped-oscillator",
    title="oscillator with a chirp",
    formula="p**2/2 + omega0**2*q**2/2 - gamma*q*sin(a*t + b*t**2)",
    source="the frequency of the force is (a + 2bt)/2π, and passes through resonance",
    parameters={
        "omega0": "angular frequency without the force",
        "gamma": "amplitude of the force",
        "a": "its angular frequency at t = 0",
        "b": "half of what that grows by in unit time",
    },
    regimes={
        "through-resonance": {
            "omega0": "2",
            "gamma": "1/2",
            "a": "1",
            "b": "1/20",
            "p": "0",
            "q": "1",
        }
    },
)
