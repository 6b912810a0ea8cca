"""How an energy changes along a run."""

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class EnergyDrift:
    """H̃ − H̃₀ at the times of `t`, for H̃ up to h^`power`; None where H̃ is not defined there.

    `power` 0 is H itself. All without units; the values are the nearest float64 numbers.
    """

    power: int
    t: tuple[Fraction, ...]
    values: tuple[float | None, ...]

    @property
    def largest(self) -> float:
        """The largest |H̃ − H̃₀|."""
        return max((abs(x) for x in self.values if x is not None), default=0.0)
