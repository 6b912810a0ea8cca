"""The harmonic oscillator with a force, q'' + ω₀² q = γ cos ωt, in resonance too."""

from verify.hamiltonians.forced_motion import forced_oscillator
from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="forced-oscillator",
    title="forced oscillator",
    formula="p**2/2 + omega0**2*q**2/2 - gamma*q*cos(omega*t)",
    source="Landau, Lifshitz, Mechanics, section 22",
    parameters={
        "omega0": "angular frequency without the force",
        "gamma": "amplitude of the force",
        "omega": "its angular frequency",
    },
    flow_in_time=forced_oscillator,
    regimes={
        "forced": {"omega0": "1", "gamma": "1/2", "omega": "7/5", "p": "1/3", "q": "1"},
        "resonance": {"omega0": "3/2", "gamma": "1/2", "omega": "3/2", "p": "1/3", "q": "1"},
        "free": {"omega0": "0", "gamma": "1/2", "omega": "2", "p": "1/3", "q": "1"},
        "constant-force": {"omega0": "0", "gamma": "1/2", "omega": "0", "p": "1/3", "q": "1"},
    },
)
