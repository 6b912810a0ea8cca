"""The cubic oscillator q'' + q − q² = 0: a well on the left of a barrier, and escape beyond it."""

from fractions import Fraction

from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

SYSTEM = System(
    name="cubic",
    title="cubic oscillator",
    formula="p**2/2 + q**2/2 - q**3/3",
    source="q'' = q² − q: Weierstrass's ℘; the least nonlinear escape",
    flow=in_potential(lambda _: (Fraction(0), Fraction(0), Fraction(1, 2), Fraction(-1, 3))),
    regimes={
        "well": {"p": "1/10", "q": "1/2"},
        "separatrix": {"p": "0", "q": "-1/2"},
        "separatrix-outside": {"p": "-45/16", "q": "23/8"},
        "escape": {"p": "1", "q": "1/2"},
        "escape-after-turning": {"p": "-1", "q": "1/2"},
        "escape-from-beyond": {"p": "-1/3", "q": "2"},
        "saddle": {"p": "0", "q": "1"},
    },
)
