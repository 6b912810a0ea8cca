"""Two pendulums side by side, joined by a spring."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="coupled-pendulums",
    title="two pendulums and a spring",
    formula="(p1**2 + p2**2)/2 - cos(q1) - cos(q2) + kappa*(q1 - q2)**2/2",
    source="twice the pendulum, joined by a linear spring",
    parameters={"kappa": "the strength of the spring"},
    regimes={
        "beating": {"kappa": "1/10", "p": "0, 0", "q": "1/2, 0"},
        "uncoupled": {"kappa": "0", "p": "0, 1", "q": "1, 0"},
    },
)
