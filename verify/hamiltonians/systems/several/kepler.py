"""Two bodies in their plane: H = |p|²/2 − μ/|q|. It is smooth where they do not collide.

From the pericentre an orbit of eccentricity e starts at q = (1 − e, 0) and
p = (0, √((1 + e)/(1 − e))), for μ = 1 and a semi-major axis of 1; with e = (k² − 1)/(k² + 1) that
root is k.
"""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="kepler",
    title="Kepler problem in the plane",
    formula="(p1**2 + p2**2)/2 - mu/sqrt(q1**2 + q2**2)",
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.2.1",
    parameters={"mu": "the strength of the attraction"},
    regimes={
        "circle": {"mu": "1", "p": "0, 1", "q": "1, 0"},
        "e=0.6": {"mu": "1", "p": "0, 2", "q": "2/5, 0"},
        "e=0.999": {"mu": "1", "p": "0, 45", "q": "1/1013, 0"},
    },
)
