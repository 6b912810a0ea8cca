"""Two pendulums of one mass and length, one hanging from the other. It is not T(p) + V(q)."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="double-pendulum",
    title="double pendulum",
    formula=(
        "(p1**2 - 2*p1*p2*cos(q1 - q2) + 2*p2**2)/(2*(1 + sin(q1 - q2)**2))"
        " - g*(2*cos(q1) + cos(q2))"
    ),
    source="L. D. Landau, E. M. Lifshitz, Mechanics, §5, problem 1, by Legendre's transformation",
    parameters={"g": "gravity over length"},
    regimes={
        "swinging": {"g": "1", "p": "0, 0", "q": "1/10, 1/5"},
        "from-the-side": {"g": "1", "p": "0, 0", "q": "3/2, 3/2"},
    },
)
