"""The dependence of T in H = T + V(q, t), which decides the conditions on a splitting's clocks."""

from enum import Enum


class Kinetic(Enum):
    """A class of kinetic energies T; V(q, t) is any smooth function in each of them, H = T + V."""

    GENERAL = "T(p, t)"
    AUTONOMOUS = "T(p)"
    MASS = "p²/(2m(t))"
    QUADRATIC = "p²/(2m)"

    @property
    def timed_letters(self) -> str:
        """The letters whose time counts: a drift's does where T depends on t."""
        return "KD" if self in (Kinetic.GENERAL, Kinetic.MASS) else "K"

    @property
    def quadratic(self) -> bool:
        """True if fewer conditions suffice than for every T."""
        return self in (Kinetic.MASS, Kinetic.QUADRATIC)
