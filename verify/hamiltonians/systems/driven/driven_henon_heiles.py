"""The potential of Hénon and Heiles under a periodic force along q1."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="driven-henon-heiles",
    title="driven Hénon–Heiles potential",
    formula=("(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3 - epsilon*q1*cos(omega*t)"),
    source="M. Hénon, C. Heiles, Astron. J. 69 (1964) 73, eq. 3, and a uniform force ε cos ωt",
    parameters={"epsilon": "amplitude of the force", "omega": "its angular frequency"},
    regimes={
        "weak": {"epsilon": "1/100", "omega": "2", "p": "2/5, 0", "q": "0, 1/10"},
        "near-resonance": {"epsilon": "1/50", "omega": "9/10", "p": "0, 0", "q": "1/10, 0"},
    },
)
