"""The pendulum whose point of support moves up and down: q'' + (1 + ε cos ωt) sin q = 0."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="driven-pendulum",
    title="driven pendulum",
    formula="p**2/2 - (1 + epsilon*cos(omega*t))*cos(q)",
    source="Landau, Lifshitz, Mechanics, sections 27 and 30",
    parameters={
        "epsilon": "how much gravity is changed",
        "omega": "angular frequency of the drive",
    },
    regimes={
        "libration": {"epsilon": "1/2", "omega": "2", "p": "0", "q": "3/2"},
        "rest": {"epsilon": "1/2", "omega": "2", "p": "0", "q": "0"},
    },
)
