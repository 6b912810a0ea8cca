"""The quartic oscillator q'' + q³ = 0, whose frequency is proportional to its amplitude."""

from fractions import Fraction

from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

SYSTEM = System(
    name="quartic",
    title="quartic oscillator",
    formula="p**2/2 + q**4/4",
    source="q'' = −q³: lemniscatic functions",
    flow=in_potential(lambda _: (*[Fraction(0)] * 4, Fraction(1, 4))),
    regimes={"oscillation": {"p": "1/3", "q": "-3/2"}, "rest": {"p": "0", "q": "0"}},
)
