"""The potential of Hénon and Heiles: an axisymmetric galaxy's, cut off after the third order."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="henon-heiles",
    title="Hénon–Heiles potential",
    formula="(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3",
    source="M. Hénon, C. Heiles, Astron. J. 69 (1964) 73, eq. 3",
    regimes={
        "energy-1-12": {"p": "2/5, 0", "q": "0, 1/10"},
        "energy-1-8": {"p": "1/2, 0", "q": "0, 0"},
    },
)
