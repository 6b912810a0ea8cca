"""The double well q'' = b² q − q³, with wells at ±b and a barrier of height b⁴/4 between them."""

from fractions import Fraction

from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

SYSTEM = System(
    name="double-well",
    title="double well",
    formula="p**2/2 + (q**2 - b**2)**2/4",
    source="V = (q² − b²)²/4",
    parameters={"b": "distance of each well from the barrier"},
    flow=in_potential(
        lambda v: (v["b"] ** 4 / 4, Fraction(0), -(v["b"] ** 2) / 2, Fraction(0), Fraction(1, 4))
    ),
    regimes={
        "left-well": {"b": "1", "p": "1/10", "q": "-3/4"},
        "right-well": {"b": "3/2", "p": "1/10", "q": "1"},
        "over-the-barrier": {"b": "1", "p": "-4/5", "q": "1/3"},
        "separatrix": {"b": "1", "p": "4/9", "q": "4/3"},
        "near-separatrix": {"b": "1", "p": "1e-15", "q": "0"},
        "saddle": {"b": "1", "p": "0", "q": "0"},
    },
)
