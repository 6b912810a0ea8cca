"""The Lennard-Jones potential in one dimension, V = 4ε ((σ/q)¹² − (σ/q)⁶); no closed form."""

from fractions import Fraction

from verify.hamiltonians.named_system import System, Values


def _goes(values: Values, p: Fraction, q: Fraction) -> str | None:
    """Return how the orbit escapes, where E ≥ 0: the well ends at 0 from below, so that E = 0 is
    enough."""
    epsilon, sigma = values["epsilon"], values["sigma"]
    if epsilon <= 0 or sigma == 0:
        return "not known"
    part = (sigma / q) ** 6
    if p**2 / 2 + 4 * epsilon * (part**2 - part) < 0:
        return None
    return f"q goes to {'+' if q > 0 else '−'}∞ as t grows: the energy is not negative"


SYSTEM = System(
    name="lennard-jones",
    title="Lennard-Jones potential in one dimension",
    formula="p**2/2 + 4*epsilon*((sigma/q)**12 - (sigma/q)**6)",
    source="J. E. Jones, Proc. R. Soc. A 106, 1924",
    parameters={"epsilon": "depth of the well", "sigma": "where V is 0"},
    goes=_goes,
    regimes={
        "bound": {"epsilon": "1", "sigma": "1", "p": "0", "q": "3/2"},
        "free": {"epsilon": "1", "sigma": "1", "p": "-2", "q": "3/2"},
        "mirrored": {"epsilon": "1/2", "sigma": "1", "p": "1/10", "q": "-6/5"},
    },
)
