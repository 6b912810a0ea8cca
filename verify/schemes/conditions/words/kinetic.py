"""What T of H = T + V(q, t) may depend on, which decides what is asked of a splitting's clocks."""

from enum import Enum


class Kinetic(Enum):
    """V(q, t) is any smooth function in each of them, H = T + V."""

    GENERAL = "T(p, t)"
    AUTONOMOUS = "T(p)"
    MASS = "p²/(2m(t))"
    QUADRATIC = "p²/(2m)"

    @property
    def timed(self) -> str:
        """The letters whose time counts: a drift's does where T depends on t."""
        return "KD" if self in (Kinetic.GENERAL, Kinetic.MASS) else "K"

    @property
    def quadratic(self) -> bool:
        """Whether fewer conditions do than for every T."""
        return self in (Kinetic.MASS, Kinetic.QUADRATIC)
