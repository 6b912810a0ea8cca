"""ΔJ of a substep without the powers of h that divide it."""

from verify.algebra.ring import Poly
from verify.schemes.step_map import Substep, h_inside


def lowest_power(step: Substep) -> int:
    """The greatest r for which h^r divides ΔJ; 0 where h stands inside a function."""
    if h_inside(step.ring, step.p_next, step.q_next):
        return 0
    return min(step.ring.powers(step.delta_j, "h"))


def divided(step: Substep, power: int) -> Poly:
    """ΔJ / h^power, where that divides it."""
    if power == 0:
        return step.delta_j
    h = step.ring.variable("h")
    parts = step.ring.powers(step.delta_j, "h")
    return sum((h ** (n - power) * x for n, x in parts.items()), step.ring.zero)
