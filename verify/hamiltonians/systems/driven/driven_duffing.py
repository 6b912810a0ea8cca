"""The driven Duffing oscillator q'' + α q + β q³ = γ cos ωt, chaotic for some of its parameters."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="driven-duffing",
    title="driven Duffing oscillator",
    formula="p**2/2 + alpha*q**2/2 + beta*q**4/4 - gamma*q*cos(omega*t)",
    source="Guckenheimer, Holmes, Nonlinear Oscillations (Springer 1983), section 2.2; undamped",
    parameters={
        "alpha": "coefficient of the linear restoring force",
        "beta": "coefficient of the cubic one",
        "gamma": "amplitude of the drive",
        "omega": "its angular frequency",
    },
    regimes={
        "hard": {"alpha": "1", "beta": "1", "gamma": "1/2", "omega": "7/5", "p": "0", "q": "1"},
        "two-wells": {
            "alpha": "-1",
            "beta": "1",
            "gamma": "3/10",
            "omega": "6/5",
            "p": "0",
            "q": "1",
        },
    },
)
