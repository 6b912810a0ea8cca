"""The Toda oscillator, V = e^q − q − 1: stiff to the right and soft to the left; no closed form."""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="toda-oscillator",
    title="Toda oscillator",
    formula="p**2/2 + exp(q) - q - 1",
    source="one particle in M. Toda's potential; its period has no closed form",
    goes=lambda _, __, ___: None,  # V grows beyond every bound on both sides
    regimes={"oscillation": {"p": "1", "q": "-3/2"}, "rest": {"p": "0", "q": "0"}},
)
