"""The mathematical pendulum q'' + sin q = 0 (Eq. 25)."""

from verify.system import System

SYSTEM = System(
    name="pendulum",
    title="mathematical pendulum",
    formula="p**2/2 - cos(q)",
    source="Eq. 25–26",
)
