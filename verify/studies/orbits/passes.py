"""The surface that orbits pass: where one coordinate has one value, and which way; and how far two
reckonings of an orbit are one."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

State = Sequence[Any]  # the numbers of p1 … pn, q1 … qn


@dataclass(frozen=True)
class Surface:
    """`coordinate` = `value` among the coordinates `names`; passed upwards where it is `rising`."""

    names: tuple[str, ...]
    coordinate: str
    value: Fraction
    rising: bool

    @property
    def place(self) -> int:
        """Of the coordinate among all."""
        return self.names.index(self.coordinate)

    def height(self, z: State, value: Any) -> Any:
        """How far z is beyond the surface, in the direction that counts; `value` in z's numbers."""
        beyond = z[self.place] - value
        return beyond if self.rising else -beyond


@dataclass(frozen=True)
class Passes:
    """States at which an orbit is looked at, in their order; `left`: it did not reach its end."""

    states: Sequence[Mapping[str, Fraction]]
    left: bool = False


def together(
    one: Sequence[Mapping[str, Fraction]], other: Sequence[Mapping[str, Fraction]], within: Fraction
) -> tuple[int, Fraction]:
    """How many of the first states are nowhere farther apart, and how far these are at most."""
    most = Fraction(0)
    for k, (x, y) in enumerate(zip(one, other, strict=False)):
        apart = max(abs(x[name] - y[name]) for name in x)
        if apart > within:
            return k, most
        most = max(most, apart)
    return min(len(one), len(other)), most
