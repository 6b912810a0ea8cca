"""The Duffing oscillator q'' + q + δ q³ = 0 (Eq. 17)."""

from verify.system import System

SYSTEM = System(
    name="duffing",
    title="Duffing oscillator",
    formula="p**2/2 + q**2/2 + delta*q**4/4",
    source="Eq. 17–18",
    parameters={"delta": "coefficient of the cubic restoring force"},
)
